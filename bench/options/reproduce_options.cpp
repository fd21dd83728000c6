#include "bench/options/apply_option.h"
#include "bench/options/option_parts.h"

namespace tetrace {

std::vector<OptionRow> reproduce_options()
{
    return {
        {"Tables", "TABLE", "LIST",
         "The tables and figures to regenerate: " + join_names(values_of<PaperTarget>()) +
             ". Default: all except rivals, ladder and volume, which are not in the paper and are run by themselves.",
         bit(Verb::reproduce), true, append("reproduce", &Options::targets),
         usual_for(every_verb, "what to regenerate: {}")},
        {"Tables", "--builds", "LIST",
         "Which builds of the scenes: 'ours', a CDT built with the scene options; 'paper', for banana, bunny and "
         "armadillo, a CDT near the paper's counts, in a domain that contains the cameras; 'rays', tets optimised "
         "so that rays cross few faces, which decide no claim of the paper. Cubes, lattices and .tet files have "
         "only ours. Default: all.",
         bit(Verb::reproduce), true, append("--builds", &Options::paper_builds),
         usual_for(every_verb, "builds of the scenes: {}")},
        {"Tables", "--searches", "TETSxRAYS",
         "Exit searches of table5: the number of random tets, and the number of rays through each, a multiple of 8. "
         "Default: 10000x16384, as in the paper.",
         bit(Verb::reproduce), false, [](Options& o, const std::string& v) { o.searches = parse_searches(v); }},
    };
}

} // namespace tetrace
