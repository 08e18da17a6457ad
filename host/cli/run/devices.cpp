#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cl/device.h"
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"

namespace mcdem::inline cli {
namespace {

constexpr std::string_view alignment = "><<>><<";  ///< of the columns
using Row = std::array<std::string, alignment.size()>;

void print_devices() {
    const auto devices = list_devices();
    if (devices.empty()) throw no_device();
    std::vector<Row> rows{{"", "device", "kind", "units", "memory", "double", "platform"}, {}};
    for (const auto& device : devices)
        rows.push_back({std::to_string(device.index), device.name, device.gpu ? "GPU" : "CPU",
                        std::to_string(device.compute_units),
                        fmt::format("{:.1f} GB", static_cast<double>(device.memory) / 1e9),
                        device.double_precision ? "yes" : "no", device.platform + ", " + device.version});
    std::array<std::size_t, alignment.size()> width;
    for (std::size_t c = 0; c < width.size(); ++c) {
        width[c] = 3;
        for (const Row& row : rows) width[c] = std::max(width[c], row[c].size());
        for (std::size_t k = 0; k < width[c]; ++k) rows[1][c] += "─";
    }
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < width.size(); ++c)
            line += alignment[c] == '<' ? fmt::format("{:<{}}  ", row[c], width[c])
                                        : fmt::format("{:>{}}  ", row[c], width[c]);
        print_out("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
}

}  // namespace

void add_devices(CLI::App& command, int&) {
    command.footer(
        "--device takes the number in the first column, or part of the name:\n  mcdem run scenes/small.toml "
        "--out out/small --device 0\nWithout --device, a run uses MCDEM_DEVICE, else the first GPU, else the "
        "first device.");
    auto alike = std::make_shared<bool>(false);
    command.add_flag("--alike", *alike, "Print only the numbers of the devices that `mcdem distribute` uses");
    command.callback([alike] {
        if (!*alike) return print_devices();
        for (const int device : alike_devices("")) print_out("{}\n", device);
    });
}

}  // namespace mcdem::cli
