#include "bench/verbs/process_limits.h"

#include "bench/measuring/machine_load.h"
#include "bench/terminal/text.h"
#include "core/base/control_groups.h"
#include "core/base/error.h"

#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

namespace tetrace {

namespace {

/// Thread-local variables, 288 KB of them cuda_host's, are on a thread's stack too; the walks need less than 100 KB.
constexpr std::uint64_t min_stack_bytes = std::uint64_t{512} << 10;

/// OMP_STACKSIZE as OpenMP has it: a number and B, K, M or G, without one K. Empty if it is not of this form: libgomp
/// then says so, and ignores it.
std::optional<std::uint64_t> stack_bytes(std::string text)
{
    std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
    std::uint64_t number = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc() || end == text.data()) return std::nullopt;
    const std::string unit = text.substr(static_cast<std::size_t>(end - text.data()));
    if (unit.size() > 1) return std::nullopt;
    switch (unit.empty() ? 'k' : std::tolower(static_cast<unsigned char>(unit[0]))) {
    case 'b': return number;
    case 'k': return number << 10;
    case 'm': return number << 20;
    case 'g': return number << 30;
    default: return std::nullopt;
    }
}

} // namespace

void check_stacks()
{
    for (const char* const variable : {"OMP_STACKSIZE", "GOMP_STACKSIZE"}) {
        const char* const value = std::getenv(variable);
        if (const auto bytes = value != nullptr ? stack_bytes(value) : std::nullopt; bytes && *bytes < min_stack_bytes)
            throw Error(ErrorKind::usage, fmt::format("{} is {}: threads need a stack of at least {} KB; unset it, or "
                                                      "set it to {}k or more",
                                                      variable, value, min_stack_bytes >> 10, min_stack_bytes >> 10));
    }
    rlimit limit{};
    if (::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < min_stack_bytes)
        throw Error(ErrorKind::usage, fmt::format("`ulimit -s` is {} KB: threads need a stack of at least {} KB; raise "
                                                  "it with `ulimit -s {}` or more",
                                                  limit.rlim_cur >> 10, min_stack_bytes >> 10, min_stack_bytes >> 10));
}

void limit_threads()
{
    const auto threads = ControlGroups().threads();
    const int all = omp_get_max_threads();
    if (!threads || std::getenv("OMP_NUM_THREADS") != nullptr || all <= static_cast<int>(*threads)) return;
    omp_set_num_threads(static_cast<int>(*threads));
    const std::string text = std::to_string(*threads);
    // Of the builder, of lavapipe, and of PoCL, older and newer.
    for (const char* const variable :
         {"OMP_NUM_THREADS", "LP_NUM_THREADS", "POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"})
        ::setenv(variable, text.c_str(), 0);
}

void start_again_if_busy(const std::vector<std::string>& arguments)
{
    if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
    const LoadMeter meter;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const auto load = meter.load();
    if (!load || load->is_quiet()) return;
    ::setenv("GOMP_SPINCOUNT", "2000", 1);
    say("tetrace: other processes use the processors; OpenMP's threads sleep while they wait (GOMP_SPINCOUNT=2000)");
    std::string name = program_invocation_name;
    std::vector<std::string> words = arguments;
    std::vector<char*> argv{name.data()};
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execv("/proc/self/exe", argv.data());
    ::unsetenv("GOMP_SPINCOUNT");
}

} // namespace tetrace
