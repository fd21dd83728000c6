// tetrace-first: only `tetrace bench`, so that a new machine has a table before the rest is compiled (make first).
#include "bench/verbs/commands.h"
#include "core/base/error.h"

namespace {

int run_verb(const tetrace::Options& options)
{
    if (options.verb == tetrace::Verb::bench) return tetrace::bench_command(options);
    throw tetrace::Error(tetrace::ErrorKind::usage,
                         "tetrace-first has only the verb bench; `make build` builds tetrace, which has all of them");
}

} // namespace

int main(int argc, char** argv)
{
    return tetrace::run_program({argv + 1, argv + argc}, {run_verb});
}
