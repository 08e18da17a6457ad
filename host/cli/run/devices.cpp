#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cl/device.h"
#include "cli/run/checked_device.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/standard_streams.h"

namespace mcdem::inline cli {
namespace {

using Row = std::vector<std::string>;

/// `alignment`: < or > for each column. The first row is the head.
void print_table(std::string_view alignment, std::vector<Row> rows) {
    std::vector<std::size_t> width(alignment.size(), 3);
    for (const Row& row : rows)
        for (std::size_t c = 0; c < width.size(); ++c) width[c] = std::max(width[c], row[c].size());
    Row rule(width.size());
    for (std::size_t c = 0; c < width.size(); ++c)
        for (std::size_t k = 0; k < width[c]; ++k) rule[c] += "─";
    rows.insert(rows.begin() + 1, rule);
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < width.size(); ++c)
            line += alignment[c] == '<' ? fmt::format("{:<{}}  ", row[c], width[c])
                                        : fmt::format("{:>{}}  ", row[c], width[c]);
        print_out("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
}

std::vector<DeviceInfo> all_devices() {
    auto devices = list_devices();
    if (devices.empty()) throw no_device();
    return devices;
}

void print_devices() {
    std::vector<Row> rows{{"", "device", "kind", "units", "memory", "double", "platform"}};
    for (const auto& device : all_devices())
        rows.push_back({std::to_string(device.index), device.name, device.gpu ? "GPU" : "CPU",
                        std::to_string(device.compute_units),
                        fmt::format("{:.1f} GB", static_cast<double>(device.memory) / 1e9),
                        device.double_precision ? "yes" : "no", device.platform + ", " + device.version});
    print_table("><<>><<", rows);
}

/// One row for a precision of a device; returns whether it passed.
bool check_one(const DeviceInfo& info, Precision precision, std::vector<Row>& rows) {
    const std::string number = std::to_string(info.index), precise(name(precision));
    try {
        Device device(number);
        const DeviceCheck check = check_and_record(device, precision);
        rows.push_back({number, info.name, precise, fmt::format("{:.1e}", check.difference()),
                        fmt::format("{:.0e}", check.allowed()), check.passed() ? "pass" : "fail"});
        return check.passed();
    } catch (const std::exception& error) {
        report_error(error);
        rows.push_back({number, info.name, precise, "", "", "fail"});
        return false;
    }
}

int check_devices() {
    std::vector<Row> rows{{"", "device", "precision", "largest difference", "allowed", "result"}};
    bool all_passed = true;
    for (const DeviceInfo& info : all_devices())
        for (const Precision precision : {Precision::single_precision, Precision::double_precision})
            if (precision == Precision::single_precision || info.double_precision)
                all_passed &= check_one(info, precision, rows);
    print_table("><<>><", rows);
    return all_passed ? exit_done : exit_failed;
}

}  // namespace

void add_devices(CLI::App& command, int& exit_code) {
    command.footer(
        "--device takes the number in the first column, or part of the name:\n  mcdem run scenes/small.toml "
        "--out out/small --device 0\nWithout --device, a run uses MCDEM_DEVICE, else the first GPU, else the "
        "first device. A run compares its device with the host when that is first used, as --check does.");
    struct Wanted {
        bool alike = false, check = false;
    };
    auto wanted = std::make_shared<Wanted>();
    auto* alike = command.add_flag("--alike", wanted->alike,
                                   "Print only the numbers of the devices that `mcdem distribute` uses");
    command
        .add_flag("--check", wanted->check,
                  "Compare every device with the host: a hundred grains with each contact model, relative to "
                  "the largest value of each quantity. The exit code is 1 if a device differs by more than "
                  "rounding errors")
        ->excludes(alike);
    command.callback([wanted, &exit_code] {
        if (wanted->check)
            exit_code = check_devices();
        else if (wanted->alike)
            for (const int device : alike_devices("")) print_out("{}\n", device);
        else
            print_devices();
    });
}

}  // namespace mcdem::cli
