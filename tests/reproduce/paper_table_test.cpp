#include "bench/reproduce/paper.h"
#include "bench/reproduce/tables/paper_table.h"
#include "tests/support/temporary_folder.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// A row with a rate and one that failed.
PaperTable table_of_two_rows()
{
    return {"table9",
            "A table",
            "a paper",
            {{"method", "method"}, {"device", "device"}, {"rate", "rate", "Mrays/s"}, {"status", "status"}},
            {"A note."},
            {{"maria-is-fast", "maria is fast", ClaimVerdict::does_not_hold, "2.5 of 5."}},
            {{"maria", "openmp", Quantity{{2.5, 2, 3, false}, 5}, "ok"}, {"stp", "cuda", PaperCell(), "error: a, b"}}};
}

PaperFigure figure_of_two_points()
{
    return {"figure9",
            "A figure",
            "a paper",
            {"tets", "a ray"},
            {"time", "ms"},
            {},
            {{"maria tet80", {{10, 0.5}, {12, 0.75}}}},
            {{"time-grows", "time grows", ClaimVerdict::holds, "0.99."}}};
}

} // namespace

TEST(PaperTable, as_csv_has_numbers_texts_points_verdicts_and_notes)
{
    EXPECT_EQ(tidy_table({table_of_two_rows()}, {figure_of_two_points()}).csv(),
              "table,scene,build,method,layout,device,quantity,unit,value,low,high,paper,ratio,x,verdict,text\n"
              "table9,,,maria,,openmp,rate,Mrays/s,2.5,2,3,5,0.5,,,\n"
              "table9,,,maria,,openmp,status,,,,,,,,,ok\n"
              "table9,,,stp,,cuda,status,,,,,,,,,\"error: a, b\"\n"
              "table9,,,,,,maria-is-fast,,,,,,,,does not hold,2.5 of 5.\n"
              "table9,,,,,,note,,,,,,,,,A note.\n"
              "figure9,,,,,,time,ms,0.5,,,,,10,,maria tet80\n"
              "figure9,,,,,,time,ms,0.75,,,,,12,,maria tet80\n"
              "figure9,,,,,,time-grows,,,,,,,,holds,0.99.\n");
}

TEST(PaperTable, a_figure_without_its_points_says_where_they_are)
{
    PaperFigure figure = figure_of_two_points();
    const std::string sentence = "The 2 points are in the result's CSV and JSON.";
    EXPECT_TRUE(contains(figure_markdown(figure), "- " + sentence));
    EXPECT_TRUE(contains(figure_text(figure), sentence));
    figure.series.clear();
    EXPECT_FALSE(contains(figure_markdown(figure), "points are"));
}

TEST(Paper, has_three_scenes_and_no_build_of_others)
{
    for (const char* const scene : {"banana", "bunny", "armadillo"}) {
        EXPECT_TRUE(paper::has_scene(scene));
        EXPECT_TRUE(paper::nearest_switches(scene).has_value()) << scene;
    }
    EXPECT_FALSE(paper::has_scene("cubes"));
    EXPECT_FALSE(paper::nearest_switches("dragon").has_value());
    EXPECT_EQ(paper::nearest_switches("armadillo"), paper::nearest_switches("bunny")) << "as for bunny";
}
