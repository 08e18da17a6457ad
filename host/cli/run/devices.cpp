#include <fmt/format.h>

#include "cl/device.h"
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "cli/shell/text_table.h"

namespace mcdem::inline cli {
namespace {

void print_devices() {
    const auto devices = list_devices();
    if (devices.empty()) throw no_device();
    TextTable table;
    table.columns = {{"", Align::right}, {"device", Align::left}, {"kind", Align::left},    {"units"},
                     {"memory"},         {"double", Align::left}, {"platform", Align::left}};
    for (const auto& device : devices)
        table.rows.push_back({std::to_string(device.index), device.name, device.gpu ? "GPU" : "CPU",
                              std::to_string(device.compute_units),
                              fmt::format("{:.1f} GB", static_cast<double>(device.memory) / 1e9),
                              device.double_precision ? "yes" : "no",
                              device.platform + ", " + device.version});
    print_out("{}", to_text(table, TableFormat::terminal));
}

}  // namespace

void add_devices(CLI::App& app, int&) {
    auto* command = app.add_subcommand("devices", "List the OpenCL devices");
    command->footer(
        "--device takes the number in the first column, or part of the name:\n  mcdem run scenes/small.toml "
        "--out out/small --device 0\nWithout --device, a run uses MCDEM_DEVICE, else the first GPU, else the "
        "first device.");
    auto alike = std::make_shared<bool>(false);
    command->add_flag("--alike", *alike,
                      "Print only the numbers of the devices that `mcdem distribute` uses");
    command->callback([alike] {
        if (!*alike) return print_devices();
        for (const int device : alike_devices("")) print_out("{}\n", device);
    });
}

}  // namespace mcdem::cli
