// Readers of options, results and journals meet inputs that nobody would write.
#include "tests/fuzz/corpus_runs.h"

using namespace tetrace::fuzz;

TEST(FuzzWords, no_changed_input_crashes_a_reader)
{
    for (const Target& target : word_targets()) {
        SCOPED_TRACE(target.name);
        run_changed(target, 1000);
    }
}
