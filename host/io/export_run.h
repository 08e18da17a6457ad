// A run's grains and contacts as files of other programs.
#pragma once
#include <filesystem>

#include "io/export_choice.h"

namespace mcdem::inline io {

struct ExportFormats {
    bool vtk = false, xyz = false;
};

/// Exports a result folder or file into a folder, which it makes. Returns the number of files of grains and
/// contacts. Throws InputError where no format is chosen, or nothing that could be exported; RunError.
int export_run(const std::filesystem::path& run, const std::filesystem::path& folder,
               const ExportFormats& formats, const ExportChoice& choice);

}  // namespace mcdem::io
