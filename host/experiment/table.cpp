#include "experiment/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
// GCC 12 sees a truncation in libfccp that is meant.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wunknown-warning-option"
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#include <libfccp/csv.h>
#include <zlib.h>

#include <algorithm>

#include "scene/packing_fields.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

/// The bytes of a file, unpacked where it is packed. Ends with a newline whether the file does or not:
/// libfccp looks one byte past the end of a last line without one.
class Bytes : public io::ByteSourceBase {
public:
    Bytes(const fs::path& file, std::string& failure) : file_(gzopen(file.c_str(), "rb")), failure_(failure) {
        if (!file_) failure_ = "cannot be opened";
    }
    ~Bytes() override {
        if (file_) gzclose(file_);
    }
    int read(char* buffer, int size) override {
        if (ended_) return 0;
        int count = file_ ? gzread(file_, buffer, static_cast<unsigned>(size)) : 0;
        int error = Z_OK;
        const char* reason = file_ ? gzerror(file_, &error) : "";
        if (count < 0 || error != Z_OK)
            failure_ = std::string("cannot be unpacked (") + reason + "): pack it again with gzip";
        if (count < size) {
            ended_ = true;
            count = std::max(count, 0);
            buffer[count++] = '\n';
        }
        return count;
    }

private:
    gzFile file_;
    std::string& failure_;
    bool ended_ = false;
};

std::string_view trimmed(std::string_view word) {
    const auto first = word.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return word.substr(first, word.find_last_not_of(" \t") - first + 1);
}

void split(std::string_view line, std::vector<std::string_view>& words) {
    words.clear();
    for (std::size_t first = 0; first != std::string_view::npos;) {
        const std::size_t comma = line.find(',', first);
        words.push_back(trimmed(line.substr(first, comma == std::string_view::npos ? comma : comma - first)));
        first = comma == std::string_view::npos ? comma : comma + 1;
    }
}

}  // namespace

std::optional<fs::path> find_table(const fs::path& folder, const std::string& name,
                                   ExperimentProblems& problems) {
    const fs::path plain = folder / name, packed = folder / (name + ".gz");
    const bool has_plain = fs::exists(plain), has_packed = fs::exists(packed);
    if (has_plain && has_packed)
        problems.add(plain.string(), "is there twice, plain and as .gz: remove the one that is out of date");
    if (has_plain) return plain;
    if (has_packed) return packed;
    return std::nullopt;
}

/// The lines that count.
class Table::Lines {
public:
    explicit Lines(const fs::path& file)
        : reader_(file.string(), std::unique_ptr<io::ByteSourceBase>(new Bytes(file, failure_))) {}
    /// Nothing at the end, and where the file cannot be read on: failure() says why.
    std::optional<std::string_view> next() {
        try {
            while (const char* line = reader_.next_line()) {
                const std::string_view text = trimmed(line);
                if (!text.empty() && text.front() != '#') return text;
            }
        } catch (const io::error::base& error) {
            failure_ = error.what();
        }
        return std::nullopt;
    }
    const std::string& failure() const { return failure_; }
    long number() const { return reader_.get_file_line(); }

private:
    std::string failure_;
    io::LineReader reader_;
};

Table::Table(const fs::path& file, const std::vector<std::string>& columns, ExperimentProblems& problems)
    : name_(file.string()), columns_(columns), problems_(problems), lines_(std::make_unique<Lines>(file)) {
    words_.resize(columns.size());
    read_header();
}

Table::~Table() = default;

void Table::read_header() {
    const auto header = lines_->next();
    std::vector<std::string_view> names;
    if (header) split(*header, names);
    const long problems_before = problems_.count();
    if (!lines_->failure().empty())
        problems_.add(name_, lines_->failure());
    else if (!header)
        problems_.add(name_,
                      fmt::format("is empty: it must begin with the header {}", fmt::join(columns_, ",")));
    line_ = lines_->number();
    for (const auto& column : columns_) {
        const auto times = std::count(names.begin(), names.end(), column);
        if (header && times != 1)
            problem(fmt::format("the header must name {} once, got it {} times: the columns are {}", column,
                                times, fmt::join(columns_, ",")));
    }
    for (std::string_view name : names) {
        const auto found = std::find(columns_.begin(), columns_.end(), name);
        column_of_word_.push_back(found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin()));
    }
    if (problems_.count() > problems_before) lines_.reset();
}

bool Table::next() {
    std::vector<std::string_view> words;
    while (lines_) {
        const auto line = lines_->next();
        if (!line) {
            if (!lines_->failure().empty()) problems_.add(name_, lines_->failure());
            lines_.reset();
            return false;
        }
        line_ = lines_->number();
        split(*line, words);
        if (words.size() == column_of_word_.size()) {
            for (std::size_t i = 0; i < words.size(); ++i)
                if (column_of_word_[i] >= 0) words_[static_cast<std::size_t>(column_of_word_[i])] = words[i];
            return true;
        }
        problem(
            fmt::format("must have {} columns as the header, got {}", column_of_word_.size(), words.size()));
    }
    return false;
}

std::optional<double> Table::number(std::size_t column) {
    const auto value = to_number(words_[column]);
    if (!value)
        problem(
            fmt::format("{} must be a finite number, got {}: leave the row out where nothing was measured",
                        columns_[column], quoted(words_[column])));
    return value;
}

std::optional<long> Table::whole_number(std::size_t column, long least) {
    const auto value = to_whole_number(words_[column]);
    if (value && *value >= least && *value <= 2'000'000'000) return value;
    problem(fmt::format("{} must be a whole number from {} on, got {}", columns_[column], least,
                        quoted(words_[column])));
    return std::nullopt;
}

std::string Table::where() const { return fmt::format("{}:{}", name_, line_); }

}  // namespace mcdem
#pragma GCC diagnostic pop
