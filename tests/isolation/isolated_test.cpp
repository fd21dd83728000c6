// The contract forwarded to another process, which is this program once more: see main().
#include "core/isolation/driver_server.h"
#include "core/isolation/isolated_backend.h"
#include "tests/isolation/erratic_backend.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <numeric>
#include <sys/wait.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::vector<Quad> some_quads(std::uint32_t count)
{
    std::vector<Quad> quads;
    for (std::uint32_t i = 0; i < count; ++i)
        quads.push_back({i, i * i, 0x7f800001u + i, ~i});
    return quads;
}

PackedScene some_scene(std::uint32_t seed)
{
    PackedScene scene;
    scene.layout = Layout::tet96;
    scene.tet_count = seed + 3;
    scene.divisions = 8;
    scene.stack_entries = seed + 1;
    scene.tets = some_quads(seed + 20);
    scene.triangles = some_quads(5);
    scene.lines = {1, 2, seed};
    scene.entry_half_faces = {seed, 5};
    return scene;
}

TraceJob some_job(std::uint32_t seed)
{
    TraceJob job{};
    job.view.origin = {0.1f, -0.0f, static_cast<float>(seed)};
    job.width = 16;
    job.height = 4;
    job.max_steps = seed;
    return job;
}

class Isolated : public ::testing::Test {
protected:
    /// limit_s: of each call; 0: as usual.
    explicit Isolated(double limit_s = 0)
    {
        DriverProcesses processes;
        processes.arguments = {"serve-driver"};
        processes.call_limit_s = limit_s;
        backend_.emplace(direct_, processes);
    }
    ~Isolated() override
    {
        backend_.reset();
        EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
        EXPECT_EQ(errno, ECHILD);
    }

    [[nodiscard]] std::unique_ptr<Session> open(const std::string& mood, const KernelId& kernel = {})
    {
        return backend_->open(0, kernel, {&mesh_, &scene_}, {.threads = 2, .program_cache = mood});
    }
    [[nodiscard]] std::unique_ptr<Session> open_directly(const KernelId& kernel = {})
    {
        return direct_.open(0, kernel, {&mesh_, &scene_}, {.threads = 2, .program_cache = ""});
    }

    PackedScene scene_ = some_scene(4);
    TriangleMesh mesh_{{{1, 2, 3}, {4, 5, 6}}, {{0, 1, 0}, {1, 1, 1}}};
    ErraticBackend direct_;
    std::optional<IsolatedBackend> backend_;
};

class Hung : public Isolated {
protected:
    Hung() : Isolated(0.4) {}
};

/// All that a session gives: the bits of its hits, and its facts.
std::vector<std::uint32_t> use(Session& session, std::uint32_t seed)
{
    session.set_rays(some_quads(64 + seed));
    std::vector<Hit> hits(64);
    const double seconds = session.trace(some_job(seed), hits);
    std::vector<std::uint32_t> words(HIT_WORDS * hits.size());
    std::memcpy(words.data(), hits.data(), 4 * words.size());
    for (const double number : {seconds, session.setup_times().compile_s, session.setup_times().upload_s,
                                session.setup_times().build_s, static_cast<double>(session.bytes())}) {
        words.push_back(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(number)));
        words.push_back(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(number) >> 32));
    }
    return words;
}

} // namespace

TEST_F(Isolated, backend_has_the_devices_facts_and_abilities_of_the_driver)
{
    ASSERT_EQ(backend_->devices().size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        ByteWriter ours, theirs;
        put_devices(ours, {backend_->devices()[i]});
        put_devices(theirs, {direct_.devices()[i]});
        EXPECT_TRUE(std::ranges::equal(ours.bytes(), theirs.bytes()));
    }
    EXPECT_EQ(backend_->name(), "erratic");
    EXPECT_EQ(backend_->clock(), "erratic clock");
    EXPECT_EQ(backend_->why_not(1, {.math = MathMode::fast}), "device 1 is never fast");
    EXPECT_EQ(backend_->why_not(1, {}), "");
    const auto quads = some_quads(999);
    EXPECT_EQ(backend_->probe(1, MathMode::fast, quads), direct_.probe(1, MathMode::fast, quads));
    EXPECT_EQ(backend_->yardstick(0, {.threads = 5})->copy_bytes_per_s, 1e12 / 3);
    EXPECT_EQ(backend_->yardstick(0, {.threads = 5})->launch_s, 1e-6 / 3 * 5);
    EXPECT_FALSE(backend_->yardstick(1, {}));
    EXPECT_TRUE(backend_->runs_defects());
    EXPECT_EQ(backend_->run_defect(1, "seven..", {30, 4}), (std::vector<std::uint32_t>{1, 7, 30, 4}));
}

TEST_F(Isolated, reduced_kernel_that_crashes_its_driver_is_an_error_and_the_next_one_runs)
{
    try {
        (void)backend_->run_defect(0, "run_defect abort", {});
        FAIL() << "it went on";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::driver);
        EXPECT_NE(std::string(error.what()).find("running the reduced kernel run_defect abort"), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(backend_->run_defect(0, "next", {}).size(), 4u);
}

TEST_F(Isolated, sessions_get_and_give_the_same_bits)
{
    for (const KernelId& kernel : {KernelId{}, KernelId{.layout = Layout::rt}, KernelId{.task = Task::rays}}) {
        const auto session = open("", kernel), direct = open_directly(kernel);
        EXPECT_EQ(use(*session, 1), use(*direct, 1));
        EXPECT_EQ(use(*session, 200), use(*direct, 200)); // rays that need more memory than those before
        EXPECT_EQ(use(*session, 3), use(*direct, 3));
    }
    const KernelId search{.task = Task::search};
    const auto session = open("", search), direct = open_directly(search);
    std::vector<std::uint32_t> faces(64), directs(64);
    EXPECT_EQ(session->search(some_job(9), faces), direct->search(some_job(9), directs));
    EXPECT_EQ(faces, directs);
}

TEST_F(Isolated, jobs_that_are_launched_together_cross_together)
{
    const auto words_of = [](const std::vector<Hit>& hits) { // floats among them may be NaN
        std::vector<std::uint32_t> words(HIT_WORDS * hits.size());
        std::memcpy(words.data(), hits.data(), 4 * words.size());
        return words;
    };
    std::vector<TraceJob> jobs = {some_job(1), some_job(2), some_job(3)};
    const auto session = open(""), direct = open_directly();
    for (const std::size_t count : {3u, 1u, 2u}) {
        std::vector<Hit> hits(64 * count), directs(64 * count);
        const std::span some = std::span(jobs).first(count);
        EXPECT_EQ(session->trace(some, hits), direct->trace(some, directs));
        EXPECT_EQ(words_of(hits), words_of(directs));
        std::vector<Hit> again(64 * count);
        if (count == 2) {
            EXPECT_NE(error_of([&] { use(*open("launch abort"), 1); }), "");
        }
        session->read_back(again);
        EXPECT_EQ(words_of(again), words_of(directs)) << "also from another process, which launches them again";
    }
}

TEST_F(Isolated, sessions_of_several_scenes_do_not_mix_them_up)
{
    const PackedScene other = some_scene(50);
    std::vector<std::unique_ptr<Session>> sessions, directs;
    for (const PackedScene* scene : std::vector<const PackedScene*>{&scene_, &other, &scene_, &other}) {
        sessions.push_back(backend_->open(0, {}, {&mesh_, scene}, {}));
        directs.push_back(direct_.open(0, {}, {&mesh_, scene}, {}));
    }
    sessions[0].reset(); // the scene goes on to live with its other session
    for (std::size_t i = 1; i < sessions.size(); ++i)
        EXPECT_EQ(use(*sessions[i], 1), use(*directs[i], 1));
    sessions.clear();
    EXPECT_EQ(use(*open(""), 1), use(*open_directly(), 1));
}

TEST_F(Isolated, errors_have_the_same_kind_and_text)
{
    for (const ErrorKind kind :
         {ErrorKind::missing, ErrorKind::unsupported, ErrorKind::internal, ErrorKind::wrong_result}) {
        const std::string how = std::to_string(static_cast<int>(kind));
        for (const char* call : {"open", "set_rays", "launch", "wait", "read"}) {
            const std::string mood = std::string(call) + " " + how;
            const auto run = [&](Backend& backend) {
                return error_of([&] { use(*backend.open(0, {}, {&mesh_, &scene_}, {.program_cache = mood}), 1); });
            };
            EXPECT_EQ(run(*backend_), run(direct_)) << mood;
            EXPECT_NE(run(*backend_), "");
        }
    }
    EXPECT_EQ(error_of([&] { use(*open("writes outside"), 1); }),
              "wrong_result: the kernel wrote before its output: the guard words there are overwritten");
    EXPECT_THROW(use(*open("wait bad_alloc"), 1), std::bad_alloc);
    EXPECT_EQ(error_of([&] { use(*open("read other"), 1); }), "driver: something else");
    EXPECT_EQ(use(*open(""), 1), use(*open_directly(), 1));
}

TEST_F(Isolated, driver_that_ends_is_an_error_of_its_call_and_other_sessions_go_on)
{
    const auto bystander = open("");
    const auto before = use(*bystander, 8);
    const struct {
        const char *how, *text;
    } ends[] = {{"abort", "was ended by signal 6 (SIGABRT, Aborted)"},
                {"segv", "was ended by signal 11 (SIGSEGV, Segmentation fault)"},
                {"kill", "was ended by signal 9 (SIGKILL, Killed), as the system does where memory is short,"},
                {"exit", "ended its process with exit code 7"}};
    const std::pair<const char*, const char*> calls[] = {{"open", "opening cdt/maria/tet80"},
                                                         {"set_rays", "copying the rays of cdt/maria/tet80"},
                                                         {"launch", "launching cdt/maria/tet80"},
                                                         {"wait", "running cdt/maria/tet80"},
                                                         {"read", "reading the hits of cdt/maria/tet80"}};
    for (const auto& [how, text] : ends)
        for (const auto& [call, doing] : calls) {
            EXPECT_EQ(error_of([&] { use(*open(std::string(call) + " " + how), 1); }),
                      std::string("driver: the driver of erratic (erratic-1.2, caf\xc3\xa9 0) ") + text + " while " +
                          doing);
            std::vector<Hit> hits(64);
            bystander->read_back(hits); // those of its last launch, in another process
            EXPECT_EQ(std::memcmp(hits.data(), before.data(), 64 * sizeof(Hit)), 0) << call << how;
        }
    const auto direct = open_directly();
    EXPECT_EQ(use(*direct, 8), before);
    EXPECT_EQ(use(*bystander, 5), use(*direct, 5));
}

TEST_F(Isolated, driver_that_crashes_in_the_middle_of_timing_ends_only_its_session)
{
    const auto bystander = open(""), bad = open("relaunch abort");
    const std::vector<Quad> rays = some_quads(64);
    bystander->set_rays(rays);
    bad->launch(some_job(1));
    static_cast<void>(bad->wait());
    bystander->launch(some_job(2));
    EXPECT_TRUE(contains(error_of([&] { bad->launch(some_job(1)); }), "SIGABRT"));
    const auto direct = open_directly();
    direct->set_rays(rays);
    direct->launch(some_job(2));
    EXPECT_EQ(bystander->wait(), direct->wait()); // of a launch that was lost, and made again
}

TEST_F(Isolated, driver_that_crashes_when_a_session_closes_harms_no_other)
{
    const auto bystander = open("");
    open("close abort").reset();
    EXPECT_EQ(use(*bystander, 1), use(*open_directly(), 1));
}

TEST_F(Isolated, session_that_cannot_be_opened_again_harms_no_other)
{
    auto refused = open("reopen " + std::to_string(static_cast<int>(ErrorKind::unsupported)));
    const auto bystander = open("");
    const ScopedVariable next("MOODY_REOPENS", "1");
    EXPECT_NE(error_of([&] { use(*open("launch abort"), 1); }), "");
    const auto direct = open_directly();
    EXPECT_EQ(use(*bystander, 1), use(*direct, 1)); // the first in its new process, as `refused` was in the old one
    EXPECT_TRUE(contains(error_of([&] { use(*refused, 1); }), "unsupported: "));
    EXPECT_TRUE(contains(error_of([&] { use(*refused, 1); }), "unsupported: "));
    refused.reset();
    EXPECT_EQ(use(*bystander, 2), use(*direct, 2));
    EXPECT_EQ(use(*open(""), 1), use(*open_directly(), 1));
}

TEST_F(Isolated, devices_have_processes_of_their_own)
{
    const auto other = backend_->open(1, {}, {&mesh_, &scene_}, {});
    EXPECT_NE(error_of([&] { use(*open("launch abort"), 1); }), "");
    EXPECT_EQ(use(*other, 1), use(*direct_.open(1, {}, {&mesh_, &scene_}, {}), 1));
}

TEST_F(Isolated, driver_that_crashes_at_its_list_of_devices_is_broken)
{
    const ScopedVariable mood("MOODY_AT_LIST", "abort");
    ASSERT_EQ(backend_->devices().size(), 1u);
    const Device& device = backend_->devices()[0];
    EXPECT_TRUE(device.broken);
    EXPECT_FALSE(device.usable);
    EXPECT_EQ(device.reason,
              "the driver of erratic was ended by signal 6 (SIGABRT, Aborted) while listing its devices");
    EXPECT_EQ(backend_->why_not(0, {}), device.reason);
    EXPECT_EQ(error_of([&] { open("").reset(); }), "driver: " + device.reason);
}

TEST_F(Isolated, program_that_does_not_serve_is_a_broken_driver)
{
    DriverProcesses processes;
    processes.program = "/bin/true";
    const IsolatedBackend backend(direct_, processes);
    EXPECT_TRUE(contains(backend.devices()[0].reason, "ended its process with exit code 0"));
    processes.program = "/nonexistent";
    EXPECT_TRUE(contains(IsolatedBackend(direct_, processes).devices()[0].reason, "No such file"));
}

TEST_F(Hung, driver_is_ended_at_its_limit_and_other_sessions_go_on)
{
    const auto bystander = open("");
    const auto before = use(*bystander, 3);
    for (const char* call : {"open", "launch", "wait", "read"})
        EXPECT_TRUE(contains(error_of([&] { use(*open(std::string(call) + " hang"), 1); }),
                             "gave no answer for 0.4 s, and was ended, while"));
    EXPECT_TRUE(contains(error_of([&] { (void)backend_->run_defect(0, "run_defect hang", {}); }),
                         "gave no answer for 0.4 s, and was ended, while running the reduced kernel"));
    EXPECT_EQ(use(*bystander, 3), before);
    EXPECT_GT(call_limit_s(1'000'000), 2 * call_limit_s(0));
}

TEST_F(Hung, driver_that_compiles_is_charged_its_processor_time)
{
    EXPECT_EQ(use(*open("open work"), 1).size(), use(*open(""), 1).size()) << "0.8 s of work is not a hang";
    EXPECT_TRUE(contains(error_of([&] { use(*open("open spin"), 1); }),
                         "gave no answer for 1.2 s of processor time, and was ended, while opening"));
    EXPECT_TRUE(contains(error_of([&] { use(*open("launch spin"), 1); }),
                         "gave no answer for 0.4 s, and was ended, while launching"))
        << "a launch does not compile";
}

TEST(Bytes, of_a_damaged_message_are_refused)
{
    ByteWriter writer;
    writer.put_text("abc");
    const auto bytes = writer.bytes();
    ByteReader cut({bytes.begin(), bytes.end() - 1});
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(cut.get_text()); }), "damaged"));
    ByteWriter count;
    count.put(~std::uint64_t{0}); // elements that no memory holds
    ByteReader huge({count.bytes().begin(), count.bytes().end()});
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(huge.get_all<Quad>()); }), "damaged"));
}

int main(int argc, char** argv)
{
    if (argc > 1 && std::string(argv[1]) == "serve-driver") {
        ErraticBackend backend;
        return serve_driver({argv + 2, argv + argc}, {&backend});
    }
    ::testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
