#include "io/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/make_folder.h"
#include "io/process_identity.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const char* const held = "held";
const char* const released = "released";

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string claim_text(const char* state, const ClaimDevice& device, long beats, double fraction) {
    const ProcessIdentity self = this_process();
    return json{{"state", state},
                {"machine", self.machine},
                {"process", self.process},
                {"started", self.started},
                {"device", {{"number", device.number}, {"name", device.name}}},
                {"beats", beats},
                {"fraction", fraction}}
               .dump() +
           "\n";
}

struct ClaimText {
    std::string state;
    ProcessIdentity holder;
    double fraction = 0;
};

/// What cannot be read was damaged: its holder shows no life, and the lease decides.
ClaimText parsed(const std::string& text) {
    const json read = json::parse(text, nullptr, false);
    if (!read.is_object()) return {held, {}, 0};
    try {
        return {read.at("state"),
                {read.at("machine"), read.at("process"), read.at("started")},
                read.at("fraction")};
    } catch (const json::exception&) {
        return {held, {}, 0};
    }
}

constexpr std::string_view claim_mark = ".claim-";

}  // namespace

Claim::Claim(std::string task, int holder, fs::path file, ClaimDevice device, Seconds beat)
    : task_(std::move(task)),
      holder_(holder),
      file_(std::move(file)),
      device_(std::move(device)),
      heart_([this, beat](const std::stop_token& stop) {
          std::unique_lock lock(mutex_);
          while (!wake_.wait_for(lock, stop, beat, [&stop] { return stop.stop_requested(); })) write(held);
      }) {}

Claim::~Claim() {
    heart_.request_stop();
    heart_.join();
    write(released);
}

void Claim::show(double fraction) {
    const std::lock_guard lock(mutex_);
    fraction_ = fraction;
}

/// A claim that cannot be written is one that others will take for lost, which costs no more than time.
void Claim::write(const char* state) {
    try {
        ++beats_;
        replace_file(file_, claim_text(state, device_, beats_, fraction_));
    } catch (const RunError&) {
    }
}

Claims::Claims(fs::path folder, ClaimDevice device, Seconds lease)
    : folder_(std::move(folder)), device_(std::move(device)), lease_(lease) {
    make_folder(folder_);
}

fs::path Claims::file_of(const std::string& task, int holder) const {
    return folder_ / fmt::format("{}{}{:06}", task, claim_mark, holder);
}

std::map<std::string, int> Claims::holders() const {
    std::map<std::string, int> newest;
    std::error_code error;
    for (auto entry = fs::directory_iterator(folder_, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        const auto mark = name.rfind(claim_mark);
        if (mark == std::string::npos || name.size() != mark + claim_mark.size() + 6) continue;
        int& holder = newest[name.substr(0, mark)];
        holder = std::max(holder, std::atoi(name.c_str() + mark + claim_mark.size()));
    }
    return newest;
}

bool Claims::is_free(const fs::path& file) {
    const std::string text = text_of(file);
    const ClaimText claim = parsed(text);
    if (claim.state == released) return true;
    const Life life = life_of(claim.holder);
    if (life != Life::cannot_be_told) return life == Life::ended;
    const auto now = std::chrono::steady_clock::now();
    const auto [seen, is_new] = seen_.try_emplace(file, Seen{text, now});
    if (seen->second.text != text) seen->second = {text, now};
    return now - seen->second.since > lease_;
}

std::unique_ptr<Claim> Claims::take_one_of(const std::vector<std::string>& tasks) {
    const std::map<std::string, int> holders = this->holders();
    std::vector<std::pair<int, std::string>> in_turn;
    for (const auto& task : tasks) {
        const auto found = holders.find(task);
        in_turn.emplace_back(found == holders.end() ? 0 : found->second, task);
    }
    // One that ended its holders comes last, so that it does not keep the others from being done.
    std::ranges::stable_sort(in_turn, {}, &std::pair<int, std::string>::first);
    for (const auto& [holder, task] : in_turn) {
        if (holder > 0 && !is_free(file_of(task, holder))) continue;
        const fs::path file = file_of(task, holder + 1);
        if (create_file(file, claim_text(held, device_, 0, 0)))
            return std::make_unique<Claim>(task, holder + 1, file, device_, lease_ / 10);
    }
    return nullptr;
}

std::map<std::string, double> Claims::under_way() const {
    std::map<std::string, double> fractions;
    for (const auto& [task, holder] : holders()) {
        const ClaimText claim = parsed(text_of(file_of(task, holder)));
        if (claim.state == held) fractions[task] = claim.fraction;
    }
    return fractions;
}

}  // namespace mcdem
