// usage: update_schema [--check] result.schema.json
// Writes what row_fields() says of a row's JSON into the schema: properties and required keys of the row and its
// groups. With --check it writes nothing and fails where the file would change.

#include "bench/output/row_fields.h"

#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

using namespace tetrace;
using json = nlohmann::ordered_json;

namespace {

constexpr std::size_t width = 140;

json reference_to(const std::string& definition)
{
    return {{"$ref", "#/$defs/" + definition}};
}

json schema_of(const RowField& field)
{
    json schema = *field.schema == '{' ? json::parse(field.schema) : reference_to(field.schema);
    if (field.what == nullptr) return schema;
    json described = {{"description", field.what}};
    described.update(schema);
    return described;
}

/// Keeps what else a definition says: its description, and which keys depend on others.
void write_fields(json& definitions)
{
    std::vector<std::string> names = {"row"};
    std::map<std::string, json> properties, required;
    required["row"] = json::array();
    for (const RowField& field : row_fields()) {
        if (field.schema == nullptr) continue;
        const std::string name = *field.group == '\0' ? "row" : field.group;
        if (properties.find(name) == properties.end() && name != "row") {
            names.push_back(name);
            if (name != ratio_group) properties["row"][name] = reference_to(name);
        }
        properties[name][field.key] = schema_of(field);
        if (field.required) required[name].push_back(field.key);
    }
    for (const std::string& name : names) {
        json& definition = definitions[name];
        definition["type"] = "object";
        definition["required"] = required[name];
        definition["additionalProperties"] = false;
        definition["properties"] = properties[name];
    }
}

std::string in_one_line(const json& value)
{
    if (!value.is_structured() || value.empty()) return value.dump();
    std::string text;
    for (const auto& [key, part] : value.items())
        text += fmt::format("{}{}{}", text.empty() ? "" : ", ", value.is_object() ? json(key).dump() + ": " : "",
                            in_one_line(part));
    return fmt::format(fmt::runtime(value.is_object() ? "{{ {} }}" : "[{}]"), text);
}

/// After `before` characters of its line: in one line if that fits, else a line per part; texts fill their lines.
std::string laid_out(const json& value, std::size_t margin, std::size_t before)
{
    const std::string line = in_one_line(value);
    if (!value.is_structured() || before + line.size() < width) return line;
    const std::string blanks(margin + 2, ' ');
    std::string text, filled;
    for (const auto& [key, part] : value.items()) {
        if (part.is_string() && value.is_array()) {
            const std::string next = part.dump() + ",";
            if (filled.size() + 1 + next.size() > width) text += filled + "\n", filled.clear();
            filled += (filled.empty() ? blanks : " ") + next;
            continue;
        }
        const std::string name = value.is_object() ? json(key).dump() + ": " : "";
        text += blanks + name + laid_out(part, margin + 2, margin + 2 + name.size()) + ",\n";
    }
    text += filled;
    text.erase(text.find_last_of(','));
    return fmt::format(fmt::runtime(value.is_object() ? "{{\n{}\n{:{}}}}" : "[\n{}\n{:{}}]"), text, "", margin);
}

} // namespace

int main(int count, char** arguments)
{
    const bool checks = count == 3 && arguments[1] == std::string_view("--check");
    if (count != (checks ? 3 : 2)) {
        std::fputs("usage: update_schema [--check] result.schema.json\n", stderr);
        return 2;
    }
    const char* const path = arguments[count - 1];
    std::ifstream in(path);
    const std::string before(std::istreambuf_iterator<char>(in), {});
    json schema = json::parse(before);
    write_fields(schema["$defs"]);
    const std::string after = laid_out(schema, 0, 0) + "\n";
    if (after == before) return 0;
    if (checks) {
        fmt::print(stderr,
                   "{} is not what row_fields() says; this updates it:\n"
                   "cmake --build build/release --target result_schema\n",
                   path);
        return 1;
    }
    std::ofstream(path) << after;
    return 0;
}
