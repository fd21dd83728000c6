#include "bench/results/result_file.h"

#include "bench/results/json_file.h"
#include "bench/results/row_keys.h"
#include "core/base/error.h"
#include "core/base/printable.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>

namespace tetrace {

namespace {

constexpr std::uint64_t oldest_schema_version = 1;
constexpr std::size_t longest_name = 1000; // of a row, in bytes
constexpr std::uint64_t max_side = 16384, max_threads = 4096;

std::string line_or_nothing(const ResultValue& object, const char* key)
{
    const auto value = object.find(key);
    return value ? value->line() : std::string();
}

std::uint64_t count_up_to(std::uint64_t most, const ResultValue& value)
{
    const std::uint64_t count = value.count();
    if (count == 0 || count > most) value.reject(fmt::format("is {}, not 1 to {}", count, most));
    return count;
}

double duration(const ResultValue& value)
{
    if (value.number() < 1e-12 || value.number() > 1e12) value.reject("is not a duration of 1e-12 to 1e12 s");
    return value.number();
}

std::string processor_of(const ResultValue& host)
{
    std::string numbers;
    for (const char* const key : {"family", "model", "stepping"})
        if (const auto number = host.find(key))
            numbers += fmt::format("{}{} {}", numbers.empty() ? "" : ", ", key, number->count());
    const std::string cpu = host.at("cpu").line();
    return numbers.empty() ? cpu : fmt::format("{} ({})", cpu, numbers);
}

std::optional<double> host_pulse_of(const ResultValue& section)
{
    const auto pulses = section.find("pulses");
    if (!pulses) return std::nullopt;
    for (const ResultValue& pulse : pulses->items())
        if (pulse.at("of").line() == "host") return duration(pulse.at("fastest_s"));
    return std::nullopt;
}

ResultScene read_scene(const ResultValue& value)
{
    ResultScene scene;
    scene.name = value.at("name").line();
    scene.hash = value.at("hash").hash();
    if (const auto hash = value.find("mesh_hash")) scene.mesh_hash = hash->hash();
    if (const auto hash = value.find("source_hash")) scene.source_hash = hash->hash();
    scene.tets_kind = line_or_nothing(value, "tets_kind");
    scene.domain = line_or_nothing(value, "domain");
    scene.switches = line_or_nothing(value, "switches");
    if (const auto divisions = value.find("divisions")) scene.divisions = divisions->count();
    if (const auto optimised = value.find("optimised")) scene.effort = optimised->at("effort").count();
    scene.camera_set = value.at("camera_set").line();
    if (const auto hash = value.find("camera_set_hash")) scene.camera_set_hash = hash->hash();
    for (const ResultValue& view : value.at("views").items())
        scene.views.push_back(view.count());
    scene.width = count_up_to(max_side, value.at("width"));
    scene.height = count_up_to(max_side, value.at("height"));
    return scene;
}

std::vector<double> read_samples(const ResultValue& row)
{
    std::vector<double> samples;
    const auto array = row.find(row_key::samples_s);
    if (!array) return samples;
    for (const ResultValue& sample : array->items())
        samples.push_back(duration(sample));
    return samples;
}

/// Results from before the key have it only in the row's name, if it is not tiles: "/schedule:packets/".
std::string read_schedule(const ResultValue& row)
{
    if (const auto schedule = row.find(row_key::schedule)) return schedule->line();
    const std::string name = row.at(row_key::name).line();
    constexpr std::string_view part = "/schedule:";
    const std::size_t place = name.find(part);
    if (place == std::string::npos) return "tiles";
    const std::size_t begin = place + part.size();
    return name.substr(begin, name.find('/', begin) - begin);
}

/// What rows of scenes and of searches have in common.
ResultRow read_any_row(const ResultValue& value)
{
    ResultRow row;
    row.name = value.at(row_key::name).line();
    if (row.name.size() > longest_name)
        value.at(row_key::name).reject("is longer than 1,000 bytes, which no row's name is");
    row.backend = value.at(row_key::backend).line();
    row.schedule = read_schedule(value);
    read_into(row.status, value.at(row_key::status));
    if (const auto reason = value.find(row_key::reason)) row.reason = printable_text(reason->text());
    if (const auto device = value.find(row_key::device)) {
        row.device = device->at("name").line();
        row.device_kind = device_kind_of(*device);
        row.driver = line_or_nothing(*device, "driver");
        if (const auto index = value.find(row_key::device_index)) row.device_index = index->count();
    }
    if (const auto threads = value.find(row_key::threads)) row.threads = count_up_to(max_threads, *threads);
    if (const auto launches = value.find(row_key::launches_in_flight))
        row.in_flight = count_up_to(max_in_flight, *launches);
    row.samples_s = read_samples(value);
    if (const auto pulse = value.find(row_key::pulse)) row.pulse_ratio = pulse->number();
    if (const auto launches = value.find(row_key::launches)) row.launches = launches->count();
    if (const auto noisy = value.find(row_key::noisy)) row.noisy = noisy->flag();
    return row;
}

ResultRow read_row(const ResultValue& value)
{
    ResultRow row = read_any_row(value);
    row.scene = value.at(row_key::scene).line();
    row.structure = row.name.substr(0, row.name.find('/'));
    if (const auto hash = value.find(row_key::hit_hash)) row.hit_hash = hash->hash();
    if (const auto hash = value.find(row_key::views_hash)) row.views_hash = hash->hash();
    if (const auto rate = value.find(row_key::mrays_per_s)) row.mrays_per_s = rate->number();
    return row;
}

ResultRow read_search(const ResultValue& value)
{
    ResultRow row = read_any_row(value);
    if (const auto hash = value.find("face_hash")) row.hit_hash = hash->hash();
    if (const auto rate = value.find("msearches_per_s")) row.mrays_per_s = rate->number();
    return row;
}

/// The items of an array that a result of some verbs has, each with a name of its own.
template <class T, class Read>
std::vector<T> read_named(const ResultValue& section, const char* key, const Read& read)
{
    std::vector<T> items;
    std::set<std::string> names;
    const auto array = section.find(key);
    if (!array) return items;
    for (const ResultValue& value : array->items()) {
        items.push_back(read(value));
        if (!names.insert(items.back().name).second)
            value.reject(fmt::format("has the name '{}', which one before it has", items.back().name));
    }
    return items;
}

template <class T>
const T* find_named(const std::vector<T>& items, const std::string& name)
{
    const auto found = std::ranges::find_if(items, [&](const T& item) { return item.name == name; });
    return found == items.end() ? nullptr : &*found;
}

} // namespace

std::string api_name(const std::string& backend, std::uint64_t index)
{
    return index > 0 ? fmt::format("{}:{}", backend, index) : backend;
}

const ResultScene* ResultFile::find_scene(const std::string& name) const
{
    return find_named(scenes, name);
}

const ResultRow* ResultFile::find_row(const std::string& name) const
{
    const ResultRow* row = find_named(rows, name);
    return row != nullptr ? row : find_named(searches, name);
}

std::vector<const ResultRow*> ResultFile::timed_rows() const
{
    std::vector<const ResultRow*> all;
    for (const auto* const list : {&rows, &searches})
        for (const ResultRow& row : *list)
            all.push_back(&row);
    return all;
}

ResultHead read_head(const ResultValue& section)
{
    ResultHead head;
    const ResultValue version = section.at("schema_version");
    head.schema_version = version.count();
    if (head.schema_version < oldest_schema_version || head.schema_version > schema_version)
        version.reject(fmt::format("is {}, and this tetrace reads {} to {}: use the tetrace that wrote the file, or a "
                                   "newer one",
                                   head.schema_version, oldest_schema_version, schema_version));
    head.verb = section.at("verb").line();
    head.date = section.at("date").line();
    head.version = section.at("version").line();
    head.commit = section.at("commit").line();
    head.cpu = section.at("host").at("cpu").line();
    head.system = section.at("host").at("system").line();
    head.label = line_or_nothing(section, "label");
    head.processor = processor_of(section.at("host"));
    head.machine = head.label.empty() ? head.processor : head.label;
    if (const auto threads = section.find("threads")) head.threads = threads->count();
    head.host_pulse_s = host_pulse_of(section);
    return head;
}

std::vector<ResultScene> read_scenes(const ResultValue& section)
{
    return read_named<ResultScene>(section, "scenes", read_scene);
}

DeviceKind device_kind_of(const ResultValue& device)
{
    const ResultValue type = device.at("type");
    const std::string name = type.line();
    if (const auto kind = value_named<DeviceKind>(name)) return *kind;
    type.reject(fmt::format("is '{}', and a device is {}", name, fmt::join(enum_names<DeviceKind>, ", ")));
}

ResultFile read_result(const std::filesystem::path& path)
{
    return result_from(read_json(path, "result", {"benchmarks", "context"}), path);
}

ResultFile result_from(nlohmann::json json, const std::filesystem::path& path)
{
    ResultFile result;
    result.path = path;
    result.json = std::move(json);
    const auto section = ResultValue(result.json, path.string()).find("tetrace");
    if (!section)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("reading the result '{}': section 'tetrace' is missing, so it is not a result; "
                                "'tetrace bench --out FILE.json' writes one",
                                path.string()));
    result.head = read_head(*section);
    // `tetrace scenes` lists other things under the same key.
    if (result.head.verb == "scenes") return result;
    result.scenes = read_scenes(*section);
    result.rows = read_named<ResultRow>(*section, "rows", read_row);
    if (const auto searches = section->find("searches")) {
        result.searches = read_named<ResultRow>(*searches, "rows", read_search);
        result.search_size = fmt::format("{} x {}", searches->at("tets").count(), searches->at("rays_a_tet").count());
    }
    return result;
}

} // namespace tetrace
