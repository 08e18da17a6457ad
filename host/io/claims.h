// Who does which task, among programs that share nothing but a folder: on one machine, or on many with a
// network file system.
#pragma once
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace mcdem {

using Seconds = std::chrono::duration<double>;

/// What a holder computes on: for those who look at its claims.
struct ClaimDevice {
    int number = -1;  ///< as in DeviceInfo::index; -1: none
    std::string name;
};

/// A task that is this program's as long as this lives. Then it is free again: whether it was done is told by
/// its result, which whoever takes it next looks for.
class Claim {
public:
    Claim(std::string task, int holder, std::filesystem::path file, ClaimDevice device, Seconds beat);
    ~Claim();
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;

    const std::string& task() const { return task_; }
    /// From 1: the how-manieth to hold this task. Each holder has its own, so files named by it are not mixed
    /// up even where one that was taken for lost comes back.
    int holder() const { return holder_; }
    /// For those who watch: the part of the task that is done.
    void show(double fraction);

private:
    void write(const char* state);
    std::string task_;
    int holder_;
    std::filesystem::path file_;
    ClaimDevice device_;
    double fraction_ = 0;
    long beats_ = 0;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread heart_;  ///< the last member: it uses the others
};

/// The claims on the tasks of one folder: files `<task>.claim-000001`, .., of which the last one counts.
class Claims {
public:
    static constexpr Seconds usual_lease{60};

    /// `lease`: a holder on another machine counts as lost once its claim shows no sign of life for so long,
    /// by the clock of this one. A holder on this machine is lost when its process has ended.
    explicit Claims(std::filesystem::path folder, ClaimDevice device = {}, Seconds lease = usual_lease);

    /// Takes one of these tasks, those first that were held least often; none where others hold all. The
    /// caller must look whether the task was done in the meantime. Throws RunError where the folder cannot be
    /// written.
    std::unique_ptr<Claim> take_one_of(const std::vector<std::string>& tasks);

    /// How far those tasks are that are held now.
    std::map<std::string, double> under_way() const;

private:
    struct Seen {
        std::string text;
        std::chrono::steady_clock::time_point since;
    };
    std::map<std::string, int> holders() const;
    std::filesystem::path file_of(const std::string& task, int holder) const;
    bool is_free(const std::filesystem::path& file);
    std::filesystem::path folder_;
    ClaimDevice device_;
    Seconds lease_;
    std::map<std::filesystem::path, Seen> seen_;
};

}  // namespace mcdem
