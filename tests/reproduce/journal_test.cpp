#include "bench/measuring/image_record.h"
#include "bench/measuring/journal.h"
#include "tests/reproduce/journal_lines.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <sstream>
#include <sys/stat.h>

using namespace tetrace;
using namespace tetrace::test;
using nlohmann::json;

namespace {

class Journals : public testing::Test {
protected:
    [[nodiscard]] std::vector<json> resumed(const json& head) const { return Journal(path_, head, true).entries(); }

    TemporaryFolder folder_;
    std::filesystem::path path_ = folder_ / "run.json.journal";
    json head_ = {{"commit", "abc"}, {"views", {1, 2, 3}}};
};

} // namespace

TEST_F(Journals, gives_back_what_was_appended)
{
    {
        Journal first(path_, head_, false);
        first.append({{"view", 1}, {"seconds", 0.1}});
        first.append({{"view", 2}, {"seconds", 1.0 / 3}});
    }
    const auto entries = resumed(head_);
    ASSERT_EQ(entries.size(), 2u);
    EXPECT_EQ(entries[0]["view"], 1);
    EXPECT_EQ(entries[1]["seconds"].get<double>(), 1.0 / 3) << "every bit of a time";
}

TEST_F(Journals, goes_on_where_a_line_was_cut_off)
{
    Journal(path_, head_, false).append({{"view", 1}});
    std::ofstream(path_, std::ios::app) << R"({"view": 2, "sec)";
    {
        Journal again(path_, head_, true);
        EXPECT_EQ(again.entries().size(), 1u);
        again.append({{"view", 2}});
    }
    EXPECT_EQ(resumed(head_).size(), 2u) << "the cut line is gone from the file too";
}

TEST_F(Journals, begins_anew_where_the_head_itself_was_cut_off)
{
    write_file(path_, R"({"journal": {"com)");
    EXPECT_EQ(resumed(head_).size(), 0u);
    EXPECT_EQ(resumed(head_).size(), 0u) << "and is whole now";
}

TEST_F(Journals, of_another_run_is_refused_with_what_differs)
{
    Journal(path_, head_, false).append({{"view", 1}});
    json other = head_;
    other["commit"] = "def";
    const std::string error = error_of([&] { (void)resumed(other); });
    EXPECT_TRUE(contains(error, "usage: --resume"));
    EXPECT_TRUE(contains(error, R"(commit: "abc" there, "def" here)"));
    EXPECT_FALSE(contains(error, "views"));
    EXPECT_EQ(resumed(head_).size(), 1u) << "it is as it was";
}

TEST_F(Journals, of_a_run_that_did_not_end_is_not_overwritten_unasked)
{
    Journal(path_, head_, false).append({{"view", 1}});
    EXPECT_TRUE(contains(error_of([&] { Journal(path_, head_, false); }), "--resume"));
    EXPECT_EQ(resumed(head_).size(), 1u);
}

TEST_F(Journals, of_a_finished_run_begins_anew_or_repeats_the_run)
{
    {
        Journal whole(path_, head_, false);
        whole.append({{"view", 1}});
        whole.finish();
    }
    EXPECT_EQ(resumed(head_).size(), 1u);
    EXPECT_TRUE(Journal(path_, head_, false).entries().empty());
    EXPECT_EQ(resumed(head_).size(), 0u);
}

TEST_F(Journals, of_a_finished_run_takes_more_and_ends_again)
{
    {
        Journal whole(path_, head_, false);
        whole.append({{"view", 1}});
        whole.finish();
    }
    {
        Journal more(path_, head_, true);
        more.append({{"view", 2}});
        more.finish();
    }
    EXPECT_EQ(resumed(head_), (std::vector<json>{{{"view", 1}}, {{"view", 2}}}));
    EXPECT_TRUE(Journal(path_, head_, false).entries().empty()) << "it has ended: a new one begins unasked";
}

TEST_F(Journals, with_a_damaged_line_is_refused_by_its_number)
{
    Journal(path_, head_, false).append({{"view", 1}});
    std::ofstream(path_, std::ios::app) << "damage\n{}\n";
    EXPECT_TRUE(contains(error_of([&] { (void)resumed(head_); }), "invalid_input: line 3"));
}

TEST_F(Journals, with_any_byte_changed_is_refused)
{
    {
        Journal journal(path_, head_, false);
        journal.append({{"seconds", 0.125}, {"rays", 1000}});
        journal.append({{"seconds", 0.25}, {"rays", 2000}});
    }
    const std::string whole = read_text(path_);
    ASSERT_EQ(journal_of(entries_of(whole)), whole) << "a line has the checksum of its text and of the lines before";
    for (std::size_t place = 0; place + 1 < whole.size(); ++place) {
        std::string damaged = whole;
        damaged[place] = static_cast<char>(damaged[place] ^ 1);
        write_file(path_, damaged);
        const std::string error = error_of([&] { (void)resumed(head_); });
        ASSERT_TRUE(contains(error, "invalid_input: line ")) << place << error;
        ASSERT_TRUE(contains(error, "remove the file to begin anew")) << error;
    }
}

TEST_F(Journals, with_an_entry_so_deep_that_writing_it_would_exhaust_the_stack_is_refused)
{
    const std::string deep = R"({"journal":{"views":)" + std::string(100'000, '[') + std::string(100'000, ']') + "}}";
    write_file(path_, R"({"checksum":")" + hash_text(hash_of(deep)) + R"(","entry":)" + deep + "}\n");
    EXPECT_TRUE(contains(error_of([&] { (void)resumed(head_); }), "invalid_input: line 1 of the journal"));
}

TEST_F(Journals, with_lines_missing_or_in_another_order_is_refused)
{
    {
        Journal journal(path_, head_, false);
        for (const int view : {1, 2, 3})
            journal.append({{"view", view}});
    }
    std::istringstream text(read_text(path_));
    std::vector<std::string> lines(4);
    for (std::string& line : lines)
        std::getline(text, line), line += "\n";
    for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{0, 2, 3}, {0, 2, 1, 3}, {0, 1, 1, 2, 3}}) {
        std::string damaged;
        for (const std::size_t line : order)
            damaged += lines[line];
        write_file(path_, damaged);
        EXPECT_TRUE(contains(error_of([&] { (void)resumed(head_); }), "one before it is missing"));
    }
}

TEST_F(Journals, of_an_older_tetrace_is_refused_unless_its_run_ended)
{
    const std::string old = json{{"journal", head_}}.dump() + "\n" + json{{"view", 1}}.dump() + "\n";
    write_file(path_, old);
    EXPECT_TRUE(contains(error_of([&] { (void)resumed(head_); }), "usage: '"));
    EXPECT_TRUE(contains(error_of([&] { Journal(path_, head_, false); }), "lack checksums; end that run with its"));
    write_file(path_, old + "{\"finished\":true}\n");
    EXPECT_TRUE(contains(error_of([&] { (void)resumed(head_); }), "lack checksums"));
    EXPECT_TRUE(Journal(path_, head_, false).entries().empty()) << "a new one begins";
}

TEST_F(Journals, in_whose_place_is_no_file_is_refused)
{
    const auto refused = [&](const std::filesystem::path& path) {
        EXPECT_TRUE(contains(error_of([&] { Journal(path, head_, true); }), "invalid_input: the journal '")) << path;
        EXPECT_TRUE(contains(error_of([&] { Journal(path, head_, false); }), "is not a regular file")) << path;
    };
    refused(folder_.path());
    refused("/dev/zero");
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    refused(folder_ / "pipe");
    std::filesystem::create_symlink("/dev/zero", folder_ / "link");
    refused(folder_ / "link");
}

TEST_F(Journals, is_written_by_one_run_at_a_time)
{
    const Journal first(path_, head_, false);
    EXPECT_TRUE(contains(error_of([&] { (void)resumed(head_); }), "being written by another run"));
}

TEST_F(Journals, names_the_file_that_it_cannot_write)
{
    EXPECT_TRUE(contains(error_of([&] { Journal(folder_ / "no" / "such", head_, false); }), "no/such"));
}

TEST(ImageRecord, comes_back_from_json_as_it_was)
{
    ImageRecord record;
    record.verdict.totals = {100, 50, 40, 10, 0, 500, 300, 200};
    record.verdict.verdicts = {
        100, 76, 5, 5, 4, 3, 7, 1e-7, WrongRay{4, 1, 2, {7, 8, 0.1f, 0.2f, 0.3f, 9}, 6, 0.7f, "it is"}, {}};
    record.verdict.visits = {100, 2400, 470};
    record.verdict.compared = true;
    record.verdict.different = 1, record.verdict.inexact = 2, record.verdict.max_ulps = 3;
    record.verdict.first_different = DifferingRay{4, 5, 6, {1, 2, 0.5f, 0.25f, 0.1f, 3}, {2, 2, 0.5f, 0.25f, 0.1f, 3}};
    record.verdict.hit_hash = 0xFEDCBA9876543210u;
    record.verdict.kernel_s = 0.1, record.verdict.wall_s = 0.2, record.verdict.download_s = 0.3;
    record.chained_hash = 0x1u;
    record.lost_at_cap = 7;
    record.flawed = {10, 9}, record.any = {32, 1};
    record.samples_s = {0.1, 1.0 / 3}, record.wall_samples_s = {0.2, 0.4};
    record.passes = 63;
    record.gpu = GpuReadings{{{1755, 2619, 412.5, 51, "power"}, {1980, {}, {}, {}, ""}}, 4, "heat, power"};
    const json once = outcome_json(record);
    const json twice = outcome_json(outcome_from_json(json::parse(once.dump())));
    EXPECT_EQ(once, twice);
    const auto back = std::get<ImageRecord>(outcome_from_json(once));
    EXPECT_EQ(back.verdict.hit_hash, record.verdict.hit_hash);
    EXPECT_EQ(back.verdict.verdicts.first_wrong->ours, record.verdict.verdicts.first_wrong->ours);
    EXPECT_EQ(back.verdict.first_different->openmp.face_id, 2u);
    EXPECT_EQ(back.samples_s, record.samples_s);
    EXPECT_EQ(back.verdict.totals.lost_steps, 200u);
    EXPECT_EQ(back.verdict.verdicts.offset, 4u);
    EXPECT_EQ(back.verdict.verdicts.lost, 7u);
    EXPECT_EQ(back.verdict.visits.triangles, 470u);
    EXPECT_EQ(back.any.through_flat, 1u);
    EXPECT_EQ(back.passes, 63u);
    EXPECT_EQ(back.gpu->dropped, 4u);
    EXPECT_EQ(back.gpu->reasons, "heat, power");
    ASSERT_EQ(back.gpu->states.size(), 2u);
    EXPECT_EQ(back.gpu->states[0].temperature_c, 51);
    EXPECT_EQ(back.gpu->states[0].throttled, "power");
    EXPECT_EQ(back.gpu->states[1].power_w, std::nullopt);
}

TEST(ImageRecord, of_a_journal_without_passes_has_one_pass_and_impossible_ones_are_refused)
{
    json object = outcome_json(ImageRecord());
    EXPECT_FALSE(object.contains("passes") || object.contains("gpu"));
    EXPECT_EQ(std::get<ImageRecord>(outcome_from_json(object)).passes, 1u);
    for (const json& bad : {json(0), json(4097), json(-1), json(2.5)}) {
        object["passes"] = bad;
        EXPECT_THROW((void)outcome_from_json(object), std::domain_error) << bad;
    }
}

TEST(ImageRecord, an_end_of_a_row_comes_back_from_json)
{
    const auto failed = std::get<Failed>(outcome_from_json(outcome_json(Failed{ErrorKind::wrong_result, "gone"})));
    EXPECT_EQ(failed.kind, ErrorKind::wrong_result);
    EXPECT_EQ(failed.what, "gone");
    const auto skipped = std::get<Skipped>(outcome_from_json(outcome_json(Skipped{Status::unsupported, "small"})));
    EXPECT_EQ(skipped.status, Status::unsupported);
    EXPECT_EQ(skipped.reason, "small");
}
