#include "bench/options/apply_option.h"
#include "bench/options/option_parts.h"
#include "bench/options/option_values.h"
#include "core/device/defects.h"

#include <fmt/format.h>

#include <algorithm>

namespace tetrace {

namespace {

constexpr std::uint64_t max_pixels = 1u << 20; // along a side, more than any image has

/// "X,Y".
ImagePixel parse_pixel(const std::string& option, const std::string& text)
{
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || text.find(',', comma + 1) != std::string::npos)
        reject_value(option, text, "X,Y, two whole numbers from 0");
    const auto number = [&](const std::string& part) {
        return static_cast<std::uint32_t>(parse_count(option, part, 0, max_pixels));
    };
    return {number(text.substr(0, comma)), number(text.substr(comma + 1))};
}

std::string defect_names()
{
    std::vector<std::string> names;
    for (const Defect& defect : all_defects())
        names.emplace_back(defect.name);
    return join_alternatives(names);
}

/// "; 'rays', given rays", and so on.
std::string entry_help()
{
    std::string help;
    for (const Task task : values_of<Task>())
        if (traits_of(task).takes_rays) help += fmt::format("; '{}', {}", name_of(task), traits_of(task).what);
    return help;
}

/// What chosen_defect() accepts after a name.
constexpr const char* launch_of_defect =
    "NAME:ITEMS:GROUP, ITEMS 1 to 1000000 and GROUP 1 to 128 of a stressor (16 and 16 of a reduced kernel), at most "
    "65535 groups; of words_at_the_end, NAME:ITEMS:GROUP:WORDS with the words of its buffer too";

void set_defect(Options& options, const std::string& text)
{
    if (!chosen_defect(text)) reject_value("--defect", text, defect_names() + ", or " + launch_of_defect);
    options.defect = text;
}

} // namespace

std::vector<OptionRow> inspect_options()
{
    return {
        {"Compilers", "--target", "GPU",
         "Compile for this GPU, which need not be here: AMD's as RADV names them (gfx1100, navi21, gfx906, ...), "
         "by hipcc (hip:gfx90a, ...), NVIDIA's as nvcc does (sm_75, sm_90, ...). Default: gfx1100, navi21, gfx906, "
         "sm_75, sm_90; none with "
         "--backend or --device.",
         bit(Verb::inspect), true, append_text(&Options::gpus),
         usual_for(every_verb, "compile for this GPU: gfx1100, sm_90, ...")},
        {experiments, "--entry", "NAME",
         "Keep the entry points of this kind: 'outside' and 'inside', primary rays that start outside the domain or "
         "in a tet" +
             entry_help() +
             ". 'dump' writes the command of one of these with a variant's text. Default: all; of 'dump', outside.",
         bit(Verb::inspect) | bit(Verb::dump), true, append("--entry", &Options::entries)},
        {"Compilers", "--require-target", "GPU",
         "Fail with exit code 3 unless this target's compiler is here and compiles every program; "
         "or the driver, for a device of --backend and --device as 'tetrace devices' labels it (vulkan:1).",
         bit(Verb::inspect), true, append_text(&Options::required),
         usual_for(every_verb, "fail unless this GPU's compiler is here")},
        {"Compilers", "--code", "FOLDER",
         "Write the code of every program into this folder: AMD's assembly; NVIDIA's PTX, and machine code if "
         "nvdisasm is installed. Default: none.",
         bit(Verb::inspect), false, set_path("--code", &Options::code_folder),
         usual_for(every_verb, "write the code of every program")},
    };
}

std::vector<OptionRow> trace_options()
{
    const unsigned with_ray = bit(Verb::trace) | bit(Verb::dump);
    return {
        {"Ray", "--defect", "NAME",
         "Write a case of this reduced kernel of a compiler defect, or of this stressor: " + defect_names() +
             "; or another launch of it, " + launch_of_defect +
             ". Default: files of the kernel of --method and --layout, or with --scene a case of it.",
         bit(Verb::dump), false, set_defect},
        {"Ray", "--variant", "CHANGE",
         "Change the kernel by these changes, as 'check --variants' names them: that of the case, or its text alone "
         "without --scene. Default: none.",
         bit(Verb::dump), true, append_text(&Options::changes)},
        {"Ray", "--view", "N", "The view of the camera set, numbered from 0. Default: 0.", with_ray, false,
         [](Options& o, const std::string& v) { o.views = fmt::format("{}", parse_count("--view", v, 0, 1u << 30)); },
         usual_for(bit(Verb::trace), "the view of the camera set")},
        {"Ray", "--pixel", "X,Y",
         "The pixel whose ray is traced; of 'dump', the case is the work-group of that ray. 0,0 is the image's upper "
         "left. Required; of 'dump' with --scene.",
         with_ray, false, [](Options& o, const std::string& v) { o.pixel = parse_pixel("--pixel", v); },
         usual_for(bit(Verb::trace), "the pixel; 0,0 is the upper left")},
    };
}

} // namespace tetrace
