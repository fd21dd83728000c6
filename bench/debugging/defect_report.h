#pragma once

#include "bench/expectations/judgement.h"
#include "bench/options/options.h"
#include "bench/output/report.h"
#include "bench/results/result_value.h"
#include "core/base/error.h"
#include "core/device/backend.h"
#include "core/device/defects.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// What a driver showed of a defect. skipped: it did not run, because the device is not usable, or lacks what the
/// kernel needs.
enum class DefectSight { not_seen, seen, skipped, error };
template <>
inline constexpr auto enum_names<DefectSight> = names_up_to<DefectSight::error>("not seen", "seen", "skipped", "error");

/// A reduced kernel or a stressor on a device.
struct DefectRun {
    std::string backend;
    std::size_t device_index = 0; ///< in the backend's devices()
    Device device;
    const Defect* defect = nullptr;
    DefectLaunch launch{0, 0}; ///< the last one: the first that was wrong or failed, if one was; 0 if there was none
    DefectSight sight = DefectSight::not_seen;
    std::vector<std::uint32_t> wrong;     ///< places in the output of words other than the expected ones
    std::uint32_t first_word = 0;         ///< the first of them
    std::uint32_t expected_word = 0;      ///< what it should be
    std::string reason;                   ///< of skipped and error; of not_seen, that denormals were flushed
    ErrorKind kind = ErrorKind::internal; ///< of error
    double seconds = 0;                   ///< compiling included
    Judged judged;                        ///< simply conforms if it was skipped
};

/// Runs every reduced kernel (with Options::stress alone every stressor, with defects and stress both) on the devices
/// that the options keep, device after device, in the backends that have them. A device that fails is an error of its
/// run. expectations: of the runs; null: no defect is expected. Throws as select_rows() does.
[[nodiscard]] std::vector<DefectRun> run_defects(const Options& options,
                                                 const std::vector<Backend*>& backends = all_backends(),
                                                 const Expectations* expectations = nullptr);

/// 1 if a defect was seen that was not expected, or one that was expected was not seen; else the code of the first
/// error, unless it was expected, 3 if no device ran one, else 0.
[[nodiscard]] int exit_code(const std::vector<DefectRun>& runs);

/// What the runs showed, as the expectations of their implementations.
[[nodiscard]] Expectations expectations_of(const std::vector<DefectRun>& runs);

/// Defects for people, and every run flat.
struct ShownDefects {
    Sheet sheet;
    Table table;
};

/// What `check --defects` prints, and `show` prints again. section: of its result. files: lines before the verdict, on
/// what the run wrote. Throws Error{invalid_input} naming the key that is missing or of another kind.
[[nodiscard]] ShownDefects shown_defects(const ResultValue& section, const Sheet& files = {});

/// Defects against drivers: a line per defect, a column per device; what each defect is, and the first wrong word of
/// each that was seen. missing: sentences on backends without a device. expectations: those that the runs were judged
/// by; may be null. written: the files of --write-expect.
[[nodiscard]] Report defect_report(const std::vector<DefectRun>& runs, const std::vector<std::string>& missing,
                                   const Options& options, const Expectations* expectations = nullptr,
                                   const std::vector<std::filesystem::path>& written = {});

/// Whether a kernel ran on a device of this backend, or failed there.
[[nodiscard]] bool has_run_on(const std::string& backend, const std::vector<DefectRun>& runs);

/// One suite, a test case for each device and defect, which fails where the judgement does. problem: as in junit_xml().
[[nodiscard]] std::string defect_junit(const std::vector<DefectRun>& runs, const std::string& problem = {});

} // namespace tetrace
