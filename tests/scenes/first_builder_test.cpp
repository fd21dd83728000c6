#include "scenes/builder/failure.h"
#include "scenes/builder/repair/arrangement.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

// The builder of a first table (TETRACE_COMPILES) lacks arrangement.cpp.
TEST(FirstBuilder, says_that_it_cuts_no_triangles_and_what_to_build)
{
    const TrianglePair pairs[] = {{0, 1}, {0, 2}};
    try {
        static_cast<void>(cut_along_intersections(TriangleMesh(), pairs));
        FAIL() << "nothing was refused";
    } catch (const BuilderFailure& failure) {
        EXPECT_EQ(failure.code(), BUILDER_SELF_INTERSECTION);
        EXPECT_TRUE(contains(failure.what(), "2 pairs of triangles cross"));
        EXPECT_TRUE(contains(failure.what(), "`make build`"));
    }
}
