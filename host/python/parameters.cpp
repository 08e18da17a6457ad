#include "python/parameters.h"

#include <charconv>

namespace mcdem::inline python {
namespace {

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
