#include "cli/shell/messages.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <filesystem>
#include <sstream>

#include "cl/error_text.h"
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"

namespace mcdem::inline cli {
namespace {

/// The text of a message in its pattern. Allocates nothing, so that a lack of memory can be reported.
class MessageText : public spdlog::custom_flag_formatter {
public:
    void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
        const std::size_t before = out.size();
        out.append(message.payload.data(), message.payload.data() + message.payload.size());
        blank_control({out.data() + before, out.size() - before});
    }
    std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
        return std::make_unique<MessageText>();
    }
};

void say_lines(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) spdlog::error("{}", line);
}

}  // namespace

void set_up_messages() {
    auto logger =
        std::make_shared<spdlog::logger>("mcdem", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    auto pattern = std::make_unique<spdlog::pattern_formatter>();
    pattern->add_flag<MessageText>('*').set_pattern("mcdem: %*");
    logger->set_formatter(std::move(pattern));
    logger->set_error_handler([](const std::string&) {});  // ignores messages that cannot be written
    spdlog::set_default_logger(logger);
}

int report_error(const std::exception& error) {
    if (const auto* input = dynamic_cast<const InputError*>(&error)) {
        for (const auto& problem : input->problems()) say_lines(problem);
        return exit_bad_input;
    }
    if (dynamic_cast<const Interrupted*>(&error)) {
        spdlog::warn("{}", error.what());
        return exit_interrupted;
    }
    if (const auto* opencl = dynamic_cast<const cl::Error*>(&error))
        spdlog::error("{}", text_of(*opencl));
    else if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
        spdlog::error("{}: {}", file->path1().string(), file->code().message());
    else if (dynamic_cast<const std::bad_alloc*>(&error))
        spdlog::error("not enough memory");
    else
        say_lines(error.what());
    return exit_failed;
}

}  // namespace mcdem::cli
