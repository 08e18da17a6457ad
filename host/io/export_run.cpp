#include "io/export_run.h"

#include "core/errors.h"
#include "io/output_folder.h"
#include "io/result_folder.h"
#include "io/vtk.h"
#include "io/xyz.h"

namespace mcdem::inline io {

int export_run(const std::filesystem::path& run, const std::filesystem::path& folder,
               const ExportFormats& formats, const ExportChoice& choice) {
    if (!formats.vtk && !formats.xyz) throw InputError("export: choose a format: vtk, xyz or both");
    if (!std::filesystem::exists(run))
        throw InputError(run.string() + ": must be a result folder or file, got nothing there");
    result_files(run);  // throws before a folder is created
    const FolderLock lock = open_output_folder(folder);
    const int files = (formats.vtk ? export_vtk(run, folder, choice) : 0) +
                      (formats.xyz ? export_xyz(run, folder, choice) : 0);
    if (files == 0)
        throw InputError(run.string() + ": has no positions to export" +
                         (choice.scans.empty() ? "" : " at the scans that are asked for") +
                         ": run with output.positions = true");
    return files;
}

}  // namespace mcdem::io
