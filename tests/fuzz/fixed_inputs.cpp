// Runs a fuzz target without a fuzzer on inputs that are always the same, numbers FIRST to FIRST + COUNT -
// 1. An input that crashes the reader is named, so that it can be run alone.
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

namespace {

char broken[40];
int broken_length = 0;

void say_which(int signal) {
    const ssize_t written = write(STDERR_FILENO, broken, static_cast<std::size_t>(broken_length));
    (void)written;
    raise(signal);  // with the default handler
}

/// Must be called for every input: PoCL's compiler changes signal handlers.
void listen() {
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGALRM}) {
        struct sigaction action {};
        action.sa_handler = say_which;
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        sigaction(signal, &action, nullptr);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: %s FIRST COUNT\n", argv[0]);
        return 2;
    }
    const long first = std::atol(argv[1]), count = std::atol(argv[2]);
    for (long number = first; number < first + count; ++number) {
        broken_length = std::snprintf(broken, sizeof broken, "input %ld breaks it\n", number);
        std::mt19937_64 random(static_cast<std::uint64_t>(number));
        std::vector<std::uint8_t> bytes(4 + random() % 60);
        for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
        listen();
        alarm(120);
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
}
