// Effects of a power cut, for failing_files.cpp: loss of data and folder entries that were not synced.
#pragma once
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

namespace {

template <class Function>
Function real(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}
#define REAL(name) \
    static const auto real_##name = real<decltype(&::name)>(#name)  // stat: of the function, not the type

std::string setting(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

struct Settings {
    std::string below = setting("MCDEM_TEST_FILES"), log = setting("MCDEM_TEST_FAULT_LOG"),
                fault = setting("MCDEM_TEST_FAULT"), kept = setting("MCDEM_TEST_FAULT_KEPT"),
                name = setting("MCDEM_TEST_FAULT_NAME"), kinds = setting("MCDEM_TEST_FAULT_KINDS");
    long at = std::atol(setting("MCDEM_TEST_FAULT_AT").c_str());
    bool stays = !setting("MCDEM_TEST_FAULT_STAYS").empty();
    bool is_cut() const { return fault.starts_with("CUT"); }
};
const Settings& settings() {
    static const Settings made;
    return made;
}

std::string path_of(int descriptor) {
    char path[PATH_MAX];
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    const ssize_t size = readlink(link.c_str(), path, sizeof path);
    std::string text(path, size > 0 ? static_cast<std::size_t>(size) : 0);
    const std::string deleted = " (deleted)";
    return text.ends_with(deleted) ? text.substr(0, text.size() - deleted.size()) : text;
}

std::string path_of(int folder, const char* path) {
    if (path[0] == '/') return path;
    char here[PATH_MAX];
    const std::string base = folder == AT_FDCWD ? (getcwd(here, sizeof here) ? here : "") : path_of(folder);
    return base + "/" + path;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

bool counts(const std::string& path) {
    const std::string& below = settings().below;
    return !below.empty() && path.starts_with(below) &&
           (path.size() == below.size() || path[below.size()] == '/');
}

using Inode = std::pair<dev_t, ino_t>;
std::map<Inode, off_t> unsynced;  ///< files with unsynced writes, and their size at the last sync

struct Entry {
    enum Kind { made, renamed, removed, made_folder, removed_folder } kind;
    std::string path, before;            ///< renamed: from `before`
    std::string kept_path, kept_before;  ///< hard links to the previous files
};
std::vector<Entry> entries;  ///< since the last sync of their folder

std::string keep(const std::string& path) {
    REAL(link);
    static int number = 0;
    const std::string kept = settings().kept + "/" + std::to_string(number++);
    return real_link(path.c_str(), kept.c_str()) == 0 ? kept : "";
}

void note_write(int descriptor) {
    struct stat status {};
    if (settings().is_cut() && fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))
        unsynced.try_emplace({status.st_dev, status.st_ino}, 0);
}

void note_sync(int descriptor, const std::string& path) {
    struct stat status {};
    if (!settings().is_cut() || fstat(descriptor, &status) != 0) return;
    if (S_ISDIR(status.st_mode))
        std::erase_if(entries, [&](const Entry& entry) { return folder_of(entry.path) == path; });
    else
        unsynced.erase({status.st_dev, status.st_ino});
}

void lose_data(const std::string& folder) {
    DIR* open = fdopendir(::open(folder.c_str(), O_RDONLY | O_DIRECTORY));
    if (!open) return;
    while (const dirent* entry = ::readdir(open)) {
        const std::string name = entry->d_name, path = folder + "/" + name;
        struct stat status {};
        REAL(lstat);
        if (name == "." || name == ".." || real_lstat(path.c_str(), &status) != 0) continue;
        if (S_ISDIR(status.st_mode)) lose_data(path);
        const auto found = unsynced.find({status.st_dev, status.st_ino});
        if (found != unsynced.end()) (void)!::truncate(path.c_str(), std::min(found->second, status.st_size));
    }
    closedir(open);
}

void undo(const Entry& entry) {
    REAL(link);
    REAL(unlink);
    REAL(mkdir);
    REAL(rmdir);
    const auto bring_back = [&](const std::string& kept, const std::string& path) {
        if (!kept.empty()) real_link(kept.c_str(), path.c_str());
    };
    if (entry.kind == Entry::made_folder) real_rmdir(entry.path.c_str());
    if (entry.kind == Entry::removed_folder) real_mkdir(entry.path.c_str(), 0777);
    if (entry.kind == Entry::made || entry.kind == Entry::renamed) real_unlink(entry.path.c_str());
    bring_back(entry.kept_path, entry.path);
    bring_back(entry.kept_before, entry.before);
}

[[noreturn]] void cut_power() {
    const std::string fault = settings().fault, below = settings().below;
    REAL(rename);
    if (fault == "CUT")
        for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
            // A folder is restored with its contents.
            REAL(stat);
            struct stat status {};
            if (entry->kind == Entry::renamed && real_stat(entry->path.c_str(), &status) == 0 &&
                S_ISDIR(status.st_mode))
                real_rename(entry->path.c_str(), entry->before.c_str());
            else
                undo(*entry);
        }
    lose_data(below);
    kill(getpid(), SIGKILL);
    for (;;) pause();
}

}  // namespace
