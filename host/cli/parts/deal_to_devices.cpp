#include "cli/parts/deal_to_devices.h"

#include <chrono>
#include <csignal>
#include <deque>
#include <list>
#include <map>
#include <thread>

#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/subprocess.h"

namespace mcdem::inline cli {
namespace {

constexpr int max_kills = 3;  ///< per part

struct Running {
    std::size_t part;
    int device;
    Subprocess process;
};

class Dealing {
public:
    Dealing(const std::vector<std::string>& words, const std::vector<std::size_t>& parts,
            std::vector<int>& devices)
        : words_(words),
          all_(parts.size()),
          parts_(parts.begin(), parts.end()),
          devices_(devices),
          free_(devices) {}

    int all() {
        bool passed_on = false;
        while (!running_.empty() || can_start()) {
            while (can_start()) start();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (Interrupt::wanted() && !std::exchange(passed_on, true))
                for (const Running& one : running_) one.process.send(SIGTERM);
            for (auto one = running_.begin(); one != running_.end();) {
                const auto end = one->process.ended();
                if (end) note(*one, *end);
                one = end ? running_.erase(one) : std::next(one);
            }
            progress_.show(static_cast<double>(done_) / static_cast<double>(all_));
        }
        progress_.clear();
        if (code_ == exit_done && Interrupt::wanted()) code_ = exit_interrupted;
        return code_ == exit_done && !parts_.empty() ? exit_failed : code_;
    }

private:
    bool can_start() const {
        return code_ == exit_done && !Interrupt::wanted() && !parts_.empty() && !free_.empty();
    }

    void start() {
        const std::size_t part = parts_.front();
        const int device = free_.back();
        std::vector<std::string> words = words_;
        words.insert(words.end(), {"--part", std::to_string(part), "--device", std::to_string(device)});
        running_.push_back({part, device, Subprocess(words)});
        parts_.pop_front();
        free_.pop_back();
    }

    void note(const Running& one, const ProgramEnd& end) {
        if (end.signal == 0 && end.exit_code != exit_failed) {
            if (end.exit_code != exit_done) code_ = end.exit_code;
            free_.push_back(one.device);
            ++done_;
            return;
        }
        progress_.clear();
        if (end.signal != 0) {
            spdlog::warn("part {}: its process on device {} was ended by signal {}", one.part, one.device,
                         end.signal);
            free_.push_back(one.device);
            if (++kills_[one.part] >= max_kills) return;
        } else {
            spdlog::warn("part {}: has failed on device {}, which is left out from here on", one.part,
                         one.device);
            std::erase(devices_, one.device);
        }
        parts_.push_back(one.part);
    }

    const std::vector<std::string>& words_;
    std::size_t all_, done_ = 0;
    std::deque<std::size_t> parts_;
    std::vector<int>& devices_;
    std::vector<int> free_;
    std::list<Running> running_;
    std::map<std::size_t, int> kills_;
    Progress progress_{stderr, progress_style(stderr)};
    int code_ = exit_done;
};

}  // namespace

int deal_to_devices(const std::vector<std::string>& words, const std::vector<std::size_t>& parts,
                    std::vector<int>& devices) {
    return Dealing(words, parts, devices).all();
}

}  // namespace mcdem::cli
