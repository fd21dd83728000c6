#include "bench/options/apply_option.h"
#include "bench/options/option_parts.h"

namespace tetrace {

std::vector<OptionRow> sharing_options()
{
    return {
        {"Sharing", "--shard", "K/N",
         "Do the K-th of N shares of the run: every N-th view and batch of searches, of those selected. 'merge' makes "
         "one result of all N. 1/1 is the whole run. Default: under srun and mpirun the rank's share, else 1/1.",
         sharing, false, [](Options& o, const std::string& v) { o.shard = parse_shard(v); }},
        {"Sharing", "--wait", "TIME",
         "Under srun and mpirun, how long rank 0 waits for a rank that neither works nor has written its result before "
         "it gives it up. Default: 2m.",
         sharing, false, [](Options& o, const std::string& v) { o.wait_s = parse_seconds("--wait", v); }},
    };
}

std::vector<OptionRow> output_options()
{
    return {
        {"Output", "--format", "FORMAT",
         "Form of the result: table, json, csv or markdown. With --out, all but table go to that file; otherwise they "
         "replace the table on standard output. Markdown of bench, check, compare, reproduce and show is what the "
         "terminal prints, ready to post. Default: table.",
         reporting, false, [](Options& o, const std::string& v) { o.format = choose<Format>("--format", v); }},
        {"Output", "--out", "FILE",
         "Also write the result to FILE. Without --format its ending chooses the form: .json, .csv, .md, or .txt for "
         "the table. The table still goes to standard output. '-' means no file: standard output gets the result, in "
         "the "
         "form of --format.",
         reporting, false, set_result_file},
        {"Output", "--columns", "LIST",
         "Print these columns of the tables that have them, after the first one, named as in CSV and JSON: "
         "mrays_per_s,spread. A wrong name is answered by those that there are. Default: all, or on a terminal those "
         "that fit, the least important left out first.",
         measuring | bit(Verb::compare) | bit(Verb::show), true, append_text(&Options::columns)},
        {"Output", "--label", "TEXT",
         "Call this machine TEXT in the result, in 'report' and in 'compare', for example 'Zen 5, 96 cores'. "
         "Default: the processor's name, family, model and stepping.",
         measuring | bit(Verb::build) | bit(Verb::devices) | bit(Verb::reproduce), false,
         [](Options& o, const std::string& v) { o.label = parse_label(v); }},
        {"Output", "--anonymous", "",
         "Leave out of the result what identifies the machine: the host's name, and the folders of files.", reporting,
         false, set(&Options::anonymous)},
        {"Output", "--resume", "",
         "Continue the run whose journal is FILE.journal, for FILE of --out: views and batches of searches that it has "
         "are not repeated. If there is no journal, begin one.",
         bit(Verb::reproduce), false, set(&Options::resume)},
        {"Output", "--junit", "FILE",
         "Also write the result to FILE as JUnit XML, one test case a row; '-' means standard output, "
         "in place of the table. 'merge' takes it for shards of 'check'. Default: none.",
         bit(Verb::check) | bit(Verb::merge), false, set_path("--junit", &Options::junit)},
        {"Output", "--out", "FILE",
         "Write the picture to FILE, which ends in .png, .exr or .ppm. With several pictures, scene, view and kind are "
         "inserted before the ending. If FILE is a folder, the pictures in it are called SCENE-VIEW-KIND.png, or .ppm "
         "if OpenImageIO is missing (PPM needs no library). Default: the current folder.",
         bit(Verb::render), false, set_path("--out", &Options::out)},
        {"Output", "--out", "FILE", "Write the page to FILE; '-' means standard output. Default: report.html.",
         bit(Verb::report), false, set_path("--out", &Options::out)},
    };
}

} // namespace tetrace
