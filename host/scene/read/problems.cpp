#include "scene/read/problems.h"

#include <fmt/format.h>

#include "core/errors.h"

namespace mcdem::inline scene {
namespace {
constexpr std::size_t max_in_files = 20;  // problems of other files that are listed
}

void Problems::add(const Place& place, const std::string& what) {
    found_.insert({{place.line, place.column}, place.text + ": " + what});
}

void Problems::report() const {
    constexpr std::size_t most = 100;  // more would not help
    if (found_.empty()) return;
    std::vector<std::string> lines;
    for (const auto& [order, text] : found_)
        if (lines.size() < most) lines.push_back(text);
    if (found_.size() > most) lines.push_back(fmt::format(".. and {} problems more", found_.size() - most));
    throw InputError(lines);
}

bool FileProblems::full() const { return first_.size() >= max_in_files; }

void FileProblems::add(const std::string& where, const std::string& what) {
    if (!full()) first_.push_back(where + ": " + what);
    ++count_;
}

void FileProblems::add(long line, const std::string& what) {
    if (!full()) add(fmt::format("{}:{}", source_, line), what);
}

void FileProblems::add(const std::string& what) {
    if (!full()) add(source_, what);
}

std::vector<std::string> FileProblems::lines() const {
    auto problems = first_;
    const long more = count_ - static_cast<long>(first_.size());
    if (more > 0) problems.push_back(fmt::format(".. and {} more", more));
    return problems;
}

void FileProblems::report() const {
    if (!empty()) throw InputError(lines());
}

std::string shortened(const std::string& text, std::size_t longest) {
    std::string shown;
    for (char c : text.substr(0, longest)) shown += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
    return text.size() > longest ? shown + ".." : shown;
}

}  // namespace mcdem::scene
