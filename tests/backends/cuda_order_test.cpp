// In which order a CUDA device may run the launches of a session: on the emulated driver, with streams and events that
// note what waits for what.
#include "backends/cuda/driver_backend.h"
#include "backends/cuda_host/driver.h"
#include "tests/support/device_rays.h"

#include <map>
#include <set>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Launched = std::set<std::size_t>; ///< numbers of launches

/// What was ordered so far.
struct Order {
    std::map<cuda::StreamHandle, Launched> streams; ///< what the next work of each stream waits for
    std::map<cuda::EventHandle, Launched> events;   ///< the same of who waits for an event
    std::vector<Launched> before;                   ///< what each launch waits for
    std::vector<cuda::Address> outputs;             ///< where it writes
};
Order order;

/// The emulated driver, which does all work at once, with streams that differ from each other.
cuda::Driver ordered_driver()
{
    cuda::Driver driver = cuda_host::emulated_driver();
    driver.stream_create = [](cuda::StreamHandle* stream, unsigned) {
        static std::size_t streams = 0;
        *stream = reinterpret_cast<cuda::StreamHandle>(++streams);
        return cuda::success;
    };
    driver.event_record = [](cuda::EventHandle event, cuda::StreamHandle stream) {
        order.events[event] = order.streams[stream];
        return cuda_host::emulated_driver().event_record(event, stream);
    };
    driver.stream_wait_event = [](cuda::StreamHandle stream, cuda::EventHandle event, unsigned) {
        const Launched& awaited = order.events[event];
        order.streams[stream].insert(awaited.begin(), awaited.end());
        return cuda::success;
    };
    driver.launch = [](cuda::FunctionHandle function, unsigned grid_x, unsigned grid_y, unsigned grid_z,
                       unsigned block_x, unsigned block_y, unsigned block_z, unsigned shared_bytes,
                       cuda::StreamHandle stream, void** parameters, void** extra) {
        order.before.push_back(order.streams[stream]);
        order.streams[stream].insert(order.before.size() - 1);
        order.outputs.push_back(*static_cast<cuda::Address*>(parameters[2]));
        return cuda_host::emulated_driver().launch(function, grid_x, grid_y, grid_z, block_x, block_y, block_z,
                                                   shared_bytes, stream, parameters, extra);
    };
    return driver;
}

class CudaOrder : public testing::Test {
protected:
    CudaOrder()
    {
        order = {};
        backend_ = std::make_unique<cuda::DriverBackend>(
            cuda::Platform{"cuda", "none",
                           [] {
                               return cuda::LoadedDriver{ordered_driver(), {}};
                           },
                           [this] {
                               return cuda::Programs{.code = {&image_, 1}, .compiler = "the host's compiler"};
                           }});
        session_ = backend_->open(0, kernel_, rays_.data(), {});
        job_ = rays_.from_outside(16, 16);
        (void)traced(*session_, job_); // the first pass of a session is waited for
    }

    /// Traces jobs, of this number of launches each pass.
    void launch(std::size_t jobs, std::uint32_t passes, std::uint32_t in_flight)
    {
        order = {};
        job_.passes = passes;
        job_.in_flight = in_flight;
        session_->launch(std::vector(jobs, job_));
        (void)session_->wait();
        ASSERT_EQ(order.before.size(), jobs * passes);
    }
    [[nodiscard]] static bool waits_for(std::size_t later, std::size_t earlier)
    {
        return order.before[later].contains(earlier);
    }

    const KernelId kernel_{.method = Method::project, .layout = Layout::half32};
    const std::string name_ = cuda::program_of(kernel_).name();
    const EmbeddedKernel image_{name_, std::as_bytes(std::span(name_))};
    const DeviceRays rays_{make_cubes(3), Layout::half32};
    std::unique_ptr<Backend> backend_;
    std::unique_ptr<Session> session_;
    TraceJob job_;
};

} // namespace

TEST_F(CudaOrder, a_pass_waits_for_the_one_before_it)
{
    launch(1, 5, 1);
    for (std::size_t pass = 1; pass < 5; ++pass) {
        EXPECT_TRUE(waits_for(pass, pass - 1)) << pass;
        EXPECT_EQ(order.outputs[pass], order.outputs[0]);
    }
}

TEST_F(CudaOrder, of_two_in_flight_a_pass_waits_only_for_the_one_before_the_last_and_has_its_output)
{
    launch(1, 6, 2);
    EXPECT_NE(order.outputs[1], order.outputs[0]);
    for (std::size_t pass = 1; pass < 6; ++pass) {
        EXPECT_FALSE(waits_for(pass, pass - 1)) << pass;
        EXPECT_TRUE(pass < 2 || waits_for(pass, pass - 2)) << pass;
        EXPECT_EQ(order.outputs[pass], order.outputs[pass % 2]) << pass;
    }
}

TEST_F(CudaOrder, of_two_in_flight_the_jobs_of_a_pass_wait_for_all_jobs_of_the_one_before_the_last)
{
    launch(3, 5, 2); // launch 3 * pass + job
    for (std::size_t pass = 1; pass < 5; ++pass)
        for (std::size_t job = 0; job < 3; ++job)
            for (std::size_t other = 0; other < 3; ++other) {
                EXPECT_FALSE(waits_for(3 * pass + job, 3 * (pass - 1) + other)) << pass;
                EXPECT_TRUE(pass < 2 || waits_for(3 * pass + job, 3 * (pass - 2) + other)) << pass;
            }
    launch(3, 4, 1);
    for (std::size_t pass = 1; pass < 4; ++pass)
        for (std::size_t job = 0; job < 3; ++job)
            for (std::size_t other = 0; other < 3; ++other)
                EXPECT_TRUE(waits_for(3 * pass + job, 3 * (pass - 1) + other)) << pass;
}

TEST_F(CudaOrder, the_end_of_a_launch_is_that_of_all_its_passes)
{
    launch(2, 5, 3);
    std::size_t most = 0;
    for (const auto& [event, launched] : order.events)
        most = std::max(most, launched.size());
    EXPECT_EQ(most, 10u) << "the event that ends the time";
}
