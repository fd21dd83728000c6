#pragma once

#include "backends/openmp/packet_session.h"
#include "core/base/error.h"
#include "core/device/backend.h"

#include <gtest/gtest.h>

#include <string>

namespace tetrace::test {

/// Why packets with that many lanes are missing here; empty if they are not.
[[nodiscard]] inline std::string why_no_packets_of(unsigned lanes)
{
    try {
        (void)openmp::packet_kernel(lanes);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

/// A test of each width of packets, which is its parameter: visibly skipped where the processor or the build lacks it.
class PacketWidths : public testing::TestWithParam<unsigned> {
protected:
    void SetUp() override
    {
        if (const std::string reason = why_no_packets_of(GetParam()); !reason.empty()) GTEST_SKIP() << reason;
    }
};

inline std::string packet_width_name(const testing::TestParamInfo<unsigned>& info)
{
    return std::to_string(info.param) + "_lanes";
}

/// Makes a case for each width of a suite's tests.
#define TETRACE_EACH_PACKET_WIDTH(suite)                                                                               \
    INSTANTIATE_TEST_SUITE_P(each, suite, testing::ValuesIn(tetrace::packet_widths), tetrace::test::packet_width_name)

} // namespace tetrace::test
