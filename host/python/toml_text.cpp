#include "python/toml_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "core/errors.h"

namespace mcdem::inline python {

namespace {

namespace py = pybind11;

std::string in_quotes(const std::string& text) {
    std::string all = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            all += fmt::format("\\{}", c);
        else if (code < 32 || code == 127)
            all += fmt::format("\\u{:04x}", code);
        else
            all += c;
    }
    return all + "\"";
}

/// Dotted keys remain dotted.
std::string key_text(py::handle key) {
    if (!py::isinstance<py::str>(key))
        throw InputError(fmt::format("a key must be text, got {}", std::string(py::repr(key))));
    const auto text = py::cast<std::string>(key);
    const bool plain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == '-' || c == '.';
    });
    return plain ? text : in_quotes(text);
}

/// Converts a NumPy scalar to a Python scalar.
py::object plain(py::handle value) {
    const bool scalar =
        py::hasattr(value, "ndim") && py::hasattr(value, "item") && py::cast<int>(value.attr("ndim")) == 0;
    return scalar ? py::object(value.attr("item")()) : py::reinterpret_borrow<py::object>(value);
}

/// Maximum depth of nested tables and lists. A dictionary that contains itself would be endless.
constexpr int deepest = 32;
constexpr std::size_t max_items = 1'000'000;  ///< items in a list; a scene has at most a MiB of text

void expect_shallow(int depth, const std::string& where) {
    if (depth <= deepest) return;
    throw InputError(
        fmt::format("{} must hold tables and lists at most {} deep, got deeper ones: does it hold itself?",
                    where.substr(0, where.find('.')), deepest));
}

bool is_list(py::handle value) {
    return PySequence_Check(value.ptr()) && py::hasattr(value, "__len__") && !py::isinstance<py::dict>(value);
}

std::string value_text(py::handle value, const std::string& where, int depth);

std::string list_text(py::handle value, const std::string& where, int depth) {
    std::vector<std::string> items;
    for (const py::handle item : value) {
        if (items.size() == max_items)
            throw InputError(
                fmt::format("{} must be a list of at most {} values, got more", where, max_items));
        items.push_back(value_text(item, where, depth + 1));
    }
    return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string table_text(const py::dict& table, const std::string& where, int depth) {
    std::vector<std::string> items;
    for (const auto& [key, value] : table)
        items.push_back(
            fmt::format("{} = {}", key_text(key), value_text(value, where + "." + key_text(key), depth + 1)));
    return fmt::format("{{{}}}", fmt::join(items, ", "));
}

/// A value on one line.
std::string value_text(py::handle given, const std::string& where, int depth) {
    expect_shallow(depth, where);
    const py::object value = plain(given);
    if (PyBool_Check(value.ptr())) return value.is(py::bool_(true)) ? "true" : "false";
    if (py::isinstance<py::str>(value)) return in_quotes(py::cast<std::string>(value));
    if (py::hasattr(value, "__fspath__")) return in_quotes(py::cast<std::string>(value.attr("__fspath__")()));
    if (py::isinstance<py::dict>(value)) return table_text(value, where, depth);
    if (is_list(value)) return list_text(value, where, depth);
    if (PyIndex_Check(value.ptr())) return py::str(py::int_(value));
    if (py::hasattr(value, "__float__"))
        return py::repr(py::float_(py::cast<double>(value)));  // exact when read back
    throw InputError(fmt::format("{} must be a number, true or false, text, a list or a table, got {}", where,
                                 std::string(py::repr(value))));
}

/// Values first, because in TOML everything after a table's heading belongs to that table.
void append_table(std::string& text, const std::string& name, const py::dict& table, int depth) {
    expect_shallow(depth, name);
    const std::string inside = name.empty() ? "" : name + ".";
    for (const auto& [key, value] : table)
        if (!py::isinstance<py::dict>(value))
            text +=
                fmt::format("{} = {}\n", key_text(key), value_text(value, inside + key_text(key), depth + 1));
    for (const auto& [key, value] : table)
        if (py::isinstance<py::dict>(value)) {
            text += fmt::format("[{}{}]\n", inside, key_text(key));
            append_table(text, inside + key_text(key), py::reinterpret_borrow<py::dict>(value), depth + 1);
        }
}

namespace py = pybind11;

template <class Number>
bool is_all(const std::string& text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size();
}

py::object typed(const std::string& text) {
    if (text.empty()) return py::none();
    if (text == "true" || text == "false") return py::bool_(text == "true");
    if (std::uint64_t whole = 0; is_all(text, whole)) return py::int_(whole);
    if (std::int64_t whole = 0; is_all(text, whole)) return py::int_(whole);
    if (double number = 0; is_all(text, number)) return py::float_(number);
    return python_text(text);
}

}  // namespace

std::string toml_text(const py::dict& tables) {
    std::string text;
    append_table(text, "", tables, 0);
    return text;
}

std::vector<std::string> overrides_of(const py::dict& values) {
    std::vector<std::string> overrides;
    for (const auto& [key, value] : values) {
        const std::string name = key_text(key);
        overrides.push_back(name + "=" + value_text(value, name, 0));
    }
    return overrides;
}

py::str python_text(const std::string& text) {
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "surrogateescape"));
}

py::dict typed_parameters(const std::map<std::string, std::string>& parameters) {
    py::dict all;
    for (const auto& [key, text] : parameters)
        all[py::str(key)] = key == "packing.file" && !text.empty() ? python_text(text) : typed(text);
    return all;
}

}  // namespace mcdem::python
