#include "bench/verify.h"

#include "scenes/procedural.h"

#include <cstring>
#include <functional>
#include <gtest/gtest.h>

using namespace tetrace;

namespace {

using Damage = std::function<void(std::span<Hit>)>;

/// A device that answers as openmp does, and then damages the answers.
class DamagedSession : public Session {
public:
    DamagedSession(std::unique_ptr<Session> inner, Damage damage) : inner_(std::move(inner)), damage_(std::move(damage))
    {
    }
    void launch(const TraceJob& job) override { inner_->launch(job); }
    [[nodiscard]] double wait() override { return inner_->wait(); }
    void read_output(std::span<std::uint32_t> words) override
    {
        std::vector<Hit> hits((words.size() - 2 * GUARD_WORDS) / HIT_WORDS);
        inner_->read_back(hits);
        damage_(hits);
        std::fill(words.begin(), words.end(), POISON);
        std::memcpy(words.data() + GUARD_WORDS, hits.data(), hits.size() * sizeof(Hit));
    }
    [[nodiscard]] SetupTimes setup_times() const override { return inner_->setup_times(); }
    [[nodiscard]] std::uint64_t bytes() const override { return inner_->bytes(); }

private:
    std::unique_ptr<Session> inner_;
    Damage damage_;
};

class verify : public testing::Test {
protected:
    /// Verifies maria on tet80 through a damaged openmp that calls itself `backend`.
    RowRun verified(const std::string& backend, const Damage& damage)
    {
        RowKey key{"cubes", "openmp", {}, RayKind::primary, TetOrder::hilbert};
        RowRun row = open_row(key, scene_, options_);
        EXPECT_NE(row.session, nullptr) << reason_of(row);
        row.key.backend = backend;
        row.session = std::make_unique<DamagedSession>(std::move(row.session), damage);
        verify_rows({&row}, scene_, options_);
        return row;
    }

    static LoadedScene loaded_cubes()
    {
        LoadedScene loaded;
        loaded.scene = make_cubes(6);
        loaded.scene.name = "cubes";
        return loaded;
    }

    static void damage_first_hit(std::span<Hit> hits, const std::function<void(Hit&)>& change)
    {
        for (Hit& hit : hits)
            if (hit.face_id < POISON) {
                change(hit);
                return;
            }
        FAIL() << "no ray hits";
    }

    Options options_ = parse_options({"check", "--size", "40", "--views", "0,2"});
    SceneWork scene_{loaded_cubes(), options_};
};

} // namespace

TEST_F(verify, right_answers_are_ok_and_counted)
{
    const RowRun row = verified("openmp", [](std::span<Hit>) {});
    ASSERT_NE(traced(row), nullptr) << reason_of(row);
    EXPECT_EQ(status_of(row), Status::ok) << reason_of(row);
    EXPECT_EQ(traced(row)->totals.rays, 2u * 40 * 40);
    EXPECT_EQ(traced(row)->verdicts.rays, 2u * 40 * 40);
    EXPECT_FALSE(traced(row)->compared);
    EXPECT_GT(traced(row)->totals.hits, 0u);
    EXPECT_GT(traced(row)->totals.misses, 0u);
}

TEST_F(verify, another_backend_with_openmps_answers_is_ok)
{
    const RowRun row = verified("other", [](std::span<Hit>) {});
    EXPECT_EQ(status_of(row), Status::ok) << reason_of(row);
    EXPECT_TRUE(traced(row)->compared);
}

TEST_F(verify, another_backend_with_one_other_step_count_is_wrong)
{
    const RowRun row = verified("other", [](std::span<Hit> hits) { hits[41].steps += 1; });
    EXPECT_EQ(status_of(row), Status::wrong);
    EXPECT_EQ(traced(row)->different, 2u) << "one a view";
    ASSERT_TRUE(traced(row)->first_different.has_value());
    EXPECT_EQ(traced(row)->first_different->view, 0u);
    EXPECT_EQ(traced(row)->first_different->x, 1u);
    EXPECT_EQ(traced(row)->first_different->y, 1u);
}

TEST_F(verify, a_method_with_a_wrong_face_is_flawed)
{
    const RowRun row = verified("openmp", [](std::span<Hit> hits) {
        damage_first_hit(hits, [](Hit& hit) { hit.face_id = hit.face_id == 0 ? 200 : 0; });
    });
    EXPECT_EQ(status_of(row), Status::flawed);
    EXPECT_GE(traced(row)->verdicts.wrong, 2u);
    EXPECT_TRUE(traced(row)->verdicts.first_wrong.has_value());
}

TEST_F(verify, a_lost_ray_makes_a_row_wrong)
{
    const RowRun row = verified("openmp", [](std::span<Hit> hits) { hits[0].face_id = LOST; });
    EXPECT_EQ(status_of(row), Status::wrong);
    EXPECT_EQ(reason_of(row), "2 lost");
    EXPECT_EQ(traced(row)->verdicts.lost, 2u);
}

TEST_F(verify, a_wrong_parameter_makes_a_row_flawed)
{
    const RowRun row =
        verified("openmp", [](std::span<Hit> hits) { damage_first_hit(hits, [](Hit& hit) { hit.t *= 1.01f; }); });
    EXPECT_EQ(status_of(row), Status::flawed);
    EXPECT_GE(traced(row)->verdicts.wrong, 2u);
}

TEST_F(verify, a_ray_that_was_never_written_is_an_error)
{
    const RowRun row = verified("openmp", [](std::span<Hit> hits) { hits[5].face_id = POISON; });
    EXPECT_EQ(status_of(row), Status::error);
    EXPECT_NE(reason_of(row).find("1 of 1600 rays were never written"), std::string::npos) << reason_of(row);
    EXPECT_EQ(row.session, nullptr);
}

TEST_F(verify, what_a_device_throws_ends_as_the_rows_outcome)
{
    const RowRun unsupported =
        verified("openmp", [](std::span<Hit>) { throw Error(ErrorKind::unsupported, "buffer of 3 GB"); });
    EXPECT_EQ(status_of(unsupported), Status::unsupported);
    EXPECT_EQ(reason_of(unsupported), "buffer of 3 GB");
    const RowRun failed = verified("openmp", [](std::span<Hit>) { throw std::runtime_error("driver gone"); });
    EXPECT_EQ(status_of(failed), Status::error);
    EXPECT_THROW(
        static_cast<void>(verified("openmp", [](std::span<Hit>) { throw Error(ErrorKind::interrupted, "^C"); })),
        Error);
}
