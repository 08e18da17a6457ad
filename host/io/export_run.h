// Export of a run's grains and contacts for other programs.
#pragma once
#include <filesystem>

#include "io/export_choice.h"

namespace mcdem::inline io {

struct ExportFormats {
    bool vtk = false, xyz = false;
};

/// Exports a result folder or file into a folder, which is created. Returns the number of files of grains and
/// contacts. Throws InputError if no format is selected or there is nothing to export; RunError.
int export_run(const std::filesystem::path& run, const std::filesystem::path& folder,
               const ExportFormats& formats, const ExportChoice& choice);

}  // namespace mcdem::io
