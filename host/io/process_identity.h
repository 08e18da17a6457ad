// Which process something belongs to, told so that programs on other machines can tell it apart.
#pragma once
#include <string>

namespace mcdem {

struct ProcessIdentity {
    std::string machine;  ///< this start of this machine, and the name space that process numbers belong to
    long process = 0;
    long started = 0;  ///< a process number may be given out again: clock ticks after the machine's start

    bool operator==(const ProcessIdentity&) const = default;
};

ProcessIdentity this_process();

enum class Life { alive, ended, cannot_be_told };

/// Of a process on another machine nothing can be told.
Life life_of(const ProcessIdentity& process);

}  // namespace mcdem
