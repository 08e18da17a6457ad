// A layer over operator new (LD_PRELOAD) that makes allocations of the program itself fail. Allocations of
// libraries, which would end the program or are reported by the library, succeed. Calls from the program are
// counted from 1, starting at main:
//   MCDEM_TEST_MEMORY_LOG    file to which the number of calls is written at the end
//   MCDEM_TEST_MEMORY_AT     number of the first call that fails with std::bad_alloc
//   MCDEM_TEST_MEMORY_COUNT  number of consecutive failures; default: 1
#include <dlfcn.h>
#include <link.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>

namespace {

struct Range {
    std::uintptr_t begin = 0, end = 0;
    bool contains(const void* address) const {
        const auto a = reinterpret_cast<std::uintptr_t>(address);
        return a >= begin && a < end;
    }
};

/// Address range of the program's own code: the first object in the loader's list.
Range program_code() {
    Range range;
    dl_iterate_phdr(
        [](dl_phdr_info* info, std::size_t, void* found) {
            auto& range = *static_cast<Range*>(found);
            for (int k = 0; k < info->dlpi_phnum; ++k)
                if (info->dlpi_phdr[k].p_type == PT_LOAD && info->dlpi_phdr[k].p_flags & PF_X) {
                    range.begin = info->dlpi_addr + info->dlpi_phdr[k].p_vaddr;
                    range.end = range.begin + info->dlpi_phdr[k].p_memsz;
                }
            return 1;
        },
        &range);
    return range;
}

long number_in(const char* variable, long otherwise) {
    const char* text = std::getenv(variable);
    return text ? std::atol(text) : otherwise;
}

std::atomic<long> count = 0;
std::atomic<bool> in_main = false;

void* allocate(std::size_t size, std::size_t alignment, const void* caller, bool throws) {
    static const Range program = program_code();
    static const long at = number_in("MCDEM_TEST_MEMORY_AT", 0),
                      last = at + number_in("MCDEM_TEST_MEMORY_COUNT", 1) - 1;
    void* memory = nullptr;
    bool fails = false;
    if (in_main && program.contains(caller)) {
        const long number = ++count;
        fails = at > 0 && number >= at && number <= last;
    }
    if (!fails) {
        size = size == 0 ? 1 : size;
        memory = alignment == 0
                     ? std::malloc(size)
                     : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    }
    if (!memory && throws) throw std::bad_alloc();
    return memory;
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int counted_main(int count, char** words, char** environment) {
    in_main = true;
    const int exit_code = real_main(count, words, environment);
    in_main = false;
    return exit_code;
}

[[gnu::destructor]] void tell() {
    if (const char* log = std::getenv("MCDEM_TEST_MEMORY_LOG"))
        if (std::FILE* file = std::fopen(log, "w")) {
            std::fprintf(file, "%ld\n", count.load());
            std::fclose(file);
        }
}

}  // namespace

extern "C" int __libc_start_main(Main program, int count, char** words, void (*first)(), void (*last)(),
                                 void (*end)(), void* stack_end) {
    using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
    real_main = program;
    return reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"))(counted_main, count, words, first,
                                                                          last, end, stack_end);
}

#define CALLER __builtin_return_address(0)
void* operator new(std::size_t size) { return allocate(size, 0, CALLER, true); }
void* operator new[](std::size_t size) { return allocate(size, 0, CALLER, true); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, 0, CALLER, false);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, 0, CALLER, false);
}
void* operator new(std::size_t size, std::align_val_t a) {
    return allocate(size, std::size_t(a), CALLER, true);
}
void* operator new[](std::size_t size, std::align_val_t a) {
    return allocate(size, std::size_t(a), CALLER, true);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
