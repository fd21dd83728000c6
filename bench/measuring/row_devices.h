#pragma once

#include "bench/rows/row_record.h"
#include "core/device/self_test.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A device that rows of a run were opened on, and its abilities.
struct RowDevice {
    std::string backend;   ///< its name
    std::size_t index = 0; ///< in the backend's devices()
    Device device;
    std::size_t hardware = 0;   ///< equal numbers mean the same hardware, see physical_devices()
    std::vector<MathMode> math; ///< of its rows
    std::optional<Yardstick> yardstick;
    std::map<MathMode, SelfTest> self_tests;
    std::string
        problem; ///< why a microbenchmark or a self-test is missing; empty if nothing failed, or nothing applies
};

/// The devices of all opened rows, each once: grouped by hardware, emulations last within each group.
[[nodiscard]] std::vector<RowDevice> devices_of(const std::vector<RowRecord>& rows);

/// Runs microbenchmark and self-test of each device (see device_abilities.h). If an API on the host lacks a
/// microbenchmark of its own, openmp's is used; one that a device already has is kept. A device that fails keeps the
/// reason as its problem; only Error{interrupted} is thrown.
void measure_devices(std::vector<RowDevice>& devices, const SessionOptions& options,
                     const std::vector<Backend*>& backends = all_backends());

/// The index of the row's device in the list; empty if the row was not opened.
[[nodiscard]] std::optional<std::size_t> device_of(const RowRecord& row, const std::vector<RowDevice>& devices);

/// The row's estimated bandwidth over copy bandwidths of its device.
struct CopyShares {
    double of_memory;           ///< of its memory
    double of_ceiling;          ///< of the level of its memory that holds the row's scene
    double ceiling_bytes_per_s; ///< that level's
};
/// Empty if the row lacks an estimated bandwidth, or its device a microbenchmark, and for a row with fewer threads than
/// the copies had.
[[nodiscard]] std::optional<CopyShares> copy_shares(const RowRecord& row, const std::vector<RowDevice>& devices);

} // namespace tetrace
