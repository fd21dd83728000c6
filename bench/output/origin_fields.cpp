#include "bench/options/option_values.h"
#include "bench/output/field_parts.h"
#include "bench/output/row_fields.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

using namespace field_parts;
using nlohmann::json;

/// A column of `bench` and of `check`, as CSV.
RowField in_csv(const char* key, const char* title, FieldValue read)
{
    return {"", key, std::move(read), csv(title), check(title)};
}

/// A text of the head; nothing where it is empty.
auto of_head(std::string ResultHead::*member)
{
    return [=](const RowFacts& facts) {
        return facts.origin == nullptr || (facts.origin->head.*member).empty() ? json()
                                                                               : json(facts.origin->head.*member);
    };
}

/// Reads the row's scene; nothing of a scene that could not be loaded.
template <class Read>
auto of_scene(Read read)
{
    return [=](const RowFacts& facts) {
        if (facts.origin != nullptr)
            for (const ResultScene& scene : facts.origin->scenes)
                if (scene.name == facts.row->key.scene) return json(read(scene));
        return json();
    };
}

} // namespace

std::vector<RowField> origin_fields()
{
    return {
        in_csv("label", "label", of_head(&ResultHead::label)),
        in_csv("processor", "processor", of_head(&ResultHead::processor)),
        in_csv("driver", "driver",
               [](const RowRecord& row) { return row.device.driver.empty() ? json() : json(row.device.driver); }),
        in_csv("commit", "commit", of_head(&ResultHead::commit)),
        in_csv("date", "date", of_head(&ResultHead::date)),
        in_csv("camera_set", "cameras", of_scene([](const ResultScene& scene) { return scene.camera_set; })),
        in_csv("views", "views", of_scene([](const ResultScene& scene) { return views_text(scene.views); })),
        in_csv("size", "size",
               of_scene([](const ResultScene& scene) { return fmt::format("{}x{}", scene.width, scene.height); })),
    };
}

} // namespace tetrace
