#include "bench/reproduce/paper.h"
#include "bench/reproduce/tables/paper_table.h"
#include "tests/support/temporary_folder.h"

#include <cmath>

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

TEST(PaperTable, points_of_a_figure_have_seven_digits_in_json_and_csv)
{
    PaperFigure figure = figure_of_two_points();
    figure.series[0].points = {{1.0 / 3, 1e-9 / 7}, {12, 123456.75}};
    EXPECT_EQ(figure_json(figure)["series"][0]["points"].dump(), "[[0.3333333,1.428571e-10],[12.0,123456.8]]");
    const auto csv_of = [](const PaperFigure& one) { return tidy_table({}, {one}).csv(); };
    const std::string csv = csv_of(figure);
    figure.series[0].points = {{0.3333333, 1.428571e-10}, {12, 123456.8}};
    EXPECT_EQ(csv, csv_of(figure)) << "what 'show' makes of the JSON";
}

TEST(PaperTable, a_figure_without_its_points_says_where_they_are)
{
    PaperFigure figure = figure_of_two_points();
    const std::string sentence = "The 2 points are in the result's CSV and JSON.";
    EXPECT_TRUE(contains(figure_markdown(figure), "- " + sentence));
    EXPECT_TRUE(contains(figure_sheet(figure).text(), sentence));
    figure.series.clear();
    EXPECT_FALSE(contains(figure_markdown(figure), "points are"));
}

TEST(PaperTable, a_number_that_is_not_compared_is_shown_without_a_ratio)
{
    PaperTable table = table_of_two_rows();
    std::get<Quantity>(table.rows[0][2]).is_compared = false;
    const auto cell = table_json(table)["rows"][0]["rate"];
    EXPECT_EQ(cell["paper"], 5);
    EXPECT_FALSE(cell.contains("ratio"));
    EXPECT_EQ(table_json(table_of_two_rows())["rows"][0]["rate"]["ratio"], 0.5);
}

TEST(Paper, has_three_scenes_with_every_number_and_a_build_and_no_others)
{
    for (const char* const scene : {"banana", "bunny", "armadillo"}) {
        EXPECT_TRUE(paper::has_scene(scene));
        EXPECT_TRUE(paper::nearest_build(scene)) << scene;
        EXPECT_TRUE(paper::frames_of(scene)) << scene;
        for (const Method method : {Method::plane, Method::plucker, Method::stp, Method::ms06, Method::maria})
            EXPECT_TRUE(paper::wrong_rays_of(scene, method)) << scene;
        EXPECT_FALSE(paper::wrong_rays_of(scene, Method::project)) << "it does not have this method";
    }
    EXPECT_FALSE(paper::has_scene("cubes"));
    EXPECT_FALSE(paper::nearest_build("dragon"));
    EXPECT_FALSE(paper::wrong_rays_of("cubes", Method::maria));
    EXPECT_EQ(paper::nearest_build("banana")->switches, "pq5Y");
    EXPECT_EQ(paper::nearest_build("armadillo")->switches, paper::nearest_build("bunny")->switches);
}

// A digit that is copied wrongly shows where the paper prints what its other numbers give.
TEST(Paper, its_numbers_agree_with_each_other)
{
    double cpu = 0, gpu = 0;
    for (const paper::SceneFigures& scene : paper::scenes()) {
        EXPECT_EQ(std::floor(96.0 * static_cast<double>(scene.tets) * 0x1p-20), scene.memory_mib) << scene.scene;
        const auto boundary = 4 * scene.tets - 2 * (scene.occlusive_faces + scene.free_faces);
        EXPECT_GE(boundary, 76u) << scene.scene;
        EXPECT_LE(boundary, 104u) << scene.scene;
        cpu += scene.cpu_mrays / 3, gpu += scene.gpu_mrays / 3;
    }
    EXPECT_NEAR(cpu, paper::mean_mrays(paper::Place::cpu), 0.05);
    EXPECT_NEAR(gpu, paper::mean_mrays(paper::Place::gpu), 0.5);
    const auto slower = [](paper::Place place) {
        const Method older = paper::fastest_older(place).method;
        return *paper::search_ms(older, place) / *paper::search_ms(Method::maria, place) - 1;
    };
    EXPECT_NEAR(slower(paper::Place::cpu), paper::fastest_older(paper::Place::cpu).slower, 0.005);
    EXPECT_NEAR(slower(paper::Place::gpu), paper::fastest_older(paper::Place::gpu).slower, 0.03) << "it prints 59 %";
    EXPECT_NEAR(paper::view_a.tets_a_ray(), 9.2, 0.05);
    EXPECT_NEAR(paper::view_b.tets_a_ray(), 21.7, 0.05);
    EXPECT_NEAR(paper::view_a.msteps_per_s(), 239, 0.5);
    EXPECT_NEAR(paper::view_b.msteps_per_s(), 186, 0.5);
}
