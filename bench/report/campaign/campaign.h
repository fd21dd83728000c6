#pragma once

#include "bench/report/html/html.h"
#include "bench/report/report_rows.h"
#include "bench/results/result_comparison.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// A result as the page of a campaign needs it.
struct CampaignResult {
    std::filesystem::path path;
    ResultHead head;
    std::optional<double> day;                   ///< its date, in days since 1970-01-01 UTC; empty if it is none
    std::map<Status, std::size_t> statuses = {}; ///< rows and searches by status
    std::string others = {};                     ///< processors that other work took while rows were timed
    std::size_t timed = 0, noisy = 0;            ///< rows and searches
    std::vector<std::size_t> machines = {};      ///< of its rates, each once
};

/// A machine that others are compared with: the CPU of a host with a number of threads, its emulated devices, or a GPU.
struct CampaignMachine {
    DeviceKind kind = DeviceKind::cpu;
    std::string name; ///< unique among those of its kind
};

/// The rate of a row, or of a row of searches, in one result.
struct CampaignRate {
    std::size_t result = 0, machine = 0; ///< indices in the campaign
    double mrays_per_s = 0;              ///< of searches, millions of those
    std::vector<double> samples_s;       ///< at least one
    RatePulse pulse = {};
    bool noisy = false;    ///< not to be relied on, by its own samples or its machine
    bool is_right = false; ///< whether every ray's hit is right
};

/// All rates of the same work: the same row with the same rays and the same answers
/// (bench/results/result_comparison.h).
struct CampaignWork {
    std::string label;               ///< "cdt maria tet80  vulkan"
    std::string application;         ///< the API and the layout, "vulkan tet80"; empty of searches
    std::vector<CampaignRate> rates; ///< in the order of their results

    /// The newest of a machine; null if it has none.
    [[nodiscard]] const CampaignRate* newest_of(std::size_t machine) const;
};

/// Works with the same rays through the same scene, on devices of one kind.
struct CampaignGroup {
    std::string title; ///< "bunny: 4 views of smoke at 1024 × 1024, primary rays"
    std::string hash;  ///< of the scene; empty of searches
    DeviceKind kind = DeviceKind::cpu;
    std::vector<CampaignWork> works; ///< in order of appearance
};

/// Results of any number of machines and dates, read one after the other, so that memory holds only the rates.
struct Campaign {
    std::vector<CampaignResult> results; ///< by date, then in the order given
    std::vector<CampaignMachine> machines;
    std::vector<CampaignGroup> groups;
    std::vector<std::pair<std::filesystem::path, std::string>>
        left_out; ///< files that are not results, with the reason

    /// "A" for the first machine.
    [[nodiscard]] std::string letter(std::size_t machine) const { return file_letter(machine, machines.size() + 1); }
};

/// Days since 1970-01-01 of "2026-11-21T17:34:21Z"; empty for anything else.
[[nodiscard]] std::optional<double> day_of(const std::string& date);

/// Reads the files. One that is not a result, or not as results/README.md describes, is left out.
/// Throws Error{missing} for a missing file, Error{invalid_input} where none is a result.
[[nodiscard]] Campaign read_campaign(const std::vector<std::filesystem::path>& files);

// The sections of a campaign's page, in order.

[[nodiscard]] Section index_section(const Campaign& campaign);    ///< machines and results; what was left out
[[nodiscard]] Section machines_section(const Campaign& campaign); ///< machines compared, same work only
[[nodiscard]] Section trend_section(const Campaign& campaign);    ///< each machine's rates over its dates
/// Each application's efficiency on each platform, problem by problem; a problem of one platform is left out.
[[nodiscard]] Section portability_section(const Campaign& campaign);

/// The machines that have a rate in a group, ascending.
[[nodiscard]] std::vector<std::size_t> machines_in(const CampaignGroup& group);

/// Where a machine's trends are on the page.
[[nodiscard]] std::string trend_anchor(const Campaign& campaign, std::size_t machine);

/// Whether a machine has the same work in results of several dates.
[[nodiscard]] bool has_trend(const Campaign& campaign, std::size_t machine);

} // namespace tetrace
