#include "bench/options/apply_option.h"
#include "bench/options/option_parts.h"

namespace tetrace {

std::vector<OptionRow> sharing_options()
{
    return {
        {"Sharing", "--shard", "K/N",
         "Do the K-th of N shares of the run: every N-th selected view and batch of searches. 'merge' makes one "
         "result from all N. 1/1 is the whole run. Default: under srun and mpirun the rank's share, otherwise 1/1.",
         sharing, false, [](Options& o, const std::string& v) { o.shard = parse_shard(v); }},
        {"Sharing", "--wait", "TIME",
         "Under srun and mpirun, how long rank 0 waits for a rank that is not working and has not written its "
         "result. Default: 2m.",
         sharing, false, [](Options& o, const std::string& v) { o.wait_s = parse_seconds("--wait", v); }},
    };
}

std::vector<OptionRow> expectation_options()
{
    return {
        {"Expectations", "--expect", "PATH",
         "What implementations are expected to show: a file, or a folder with a file for each "
         "(tests/expected/README.md). A failure that it lists passes; a new failure and an unexpected pass exit with "
         "1. What it does not mention is expected to conform. May be repeated, or a list with commas. Default: all "
         "conforms.",
         bit(Verb::check), true, append_path("--expect", &Options::expected),
         usual_for(every_verb, "known failures: a file or folder of --write-expect")},
        {"Expectations", "--write-expect", "PATH",
         "Write what this run showed, for --expect: into one file if PATH ends in .json, else into a folder with a "
         "file for each implementation. What is there is updated. Default: none.",
         bit(Verb::check), false, set_path("--write-expect", &Options::write_expected)},
        {"Expectations", "--repeat", "N",
         "Check all rows N times, 1 to 1000. A row that differs between repetitions fails, with its rate ('wrong in 2 "
         "of 10'), unless --expect lists it among the flakes. With --out, --resume goes on after the last one that was "
         "finished. Default: 1.",
         bit(Verb::check), false, set_count("--repeat", &Options::repeat, 1, 1000)},
    };
}

std::vector<OptionRow> output_options()
{
    return {
        {"Output", "--format", "FORMAT",
         "Format of the result: table, json, csv or markdown. With --out, all except table are written to that "
         "file; otherwise they replace the table on standard output. Markdown of bench, check, compare, reproduce "
         "and show is what the terminal prints, ready to post. Default: table.",
         reporting, false, set_choice<Format>("--format", &Options::format),
         usual_for(~(tracing | bit(Verb::reproduce)), "{}")},
        {"Output", "--out", "PATH",
         "Write to the file PATH: the result, the picture of 'render', the page of 'report' or 'page'. For 'dump' it "
         "is the folder of the files, and is required, as is the .npy file of 'rays'. Without --format, its extension "
         "sets a result's format: .json, .csv, "
         ".md, or .txt for the table; the table still goes to standard output. 'build' writes the tets of a single "
         "scene to a .vtu, .vtk, .mesh (MEDIT) or .node (TetGen) file. '-' means standard output instead of a file. -o "
         "is "
         "short for it. Default: none; of 'render' the current folder, of 'report' report.html, of 'page' "
         "tetrace.html.",
         reporting | bit(Verb::render) | bit(Verb::report) | bit(Verb::page) | bit(Verb::dump) | bit(Verb::rays), false,
         set_out(), usual_for(every_verb, "where to write; -o is short for it")},
        {"Output", "--out-arrays", "FOLDER",
         "Write the verified answers as .npy files of NumPy, one for each row and view, and for task tally one with "
         "the "
         "sums of the tets (docs/volume.md). Default: none.",
         measuring, false, set_path("--out-arrays", &Options::array_folder)},
        {"Output", "--columns", "LIST",
         "Print only these columns, after the first one, in the tables that have them, named as in CSV and JSON: "
         "mrays_per_s,spread. An unknown name prints the list of valid ones. Default: all, or on a terminal the "
         "most important ones that fit.",
         measuring | bit(Verb::compare) | bit(Verb::show) | bit(Verb::merge), true, append_text(&Options::columns),
         usual_for(~measuring, "only these columns: mrays_per_s,spread")},
        {"Output", "--brief", "",
         "Print one screen: the machine, the five rows that matter most, the score, what is compared, and whether to "
         "trust "
         "it. Files have everything.",
         bit(Verb::bench) | bit(Verb::show), false, set(&Options::brief),
         usual_for(every_verb, "one screen, with a score")},
        {"Output", "--label", "TEXT",
         "Name of this machine in the result, in 'report' and in 'compare', for example 'Zen 5, 96 cores'. Default: "
         "the CPU's name, family, model and stepping.",
         measuring | bit(Verb::build) | bit(Verb::devices) | bit(Verb::reproduce), false,
         [](Options& o, const std::string& v) { o.label = parse_label(v); }},
        {"Output", "--anonymous", "",
         "Leave out of the result what identifies the machine: the host's name, and the folders of files.", reporting,
         false, set(&Options::anonymous),
         usual_for(~(building | bit(Verb::inspect)), "no host name and no folders in the result")},
        {"Output", "--resume", "",
         "Continue the run whose journal is FILE.journal, for FILE of --out: views, samples, batches of searches and "
         "repetitions in it are not done again. If the journal does not exist, start one.",
         sharing, false, set(&Options::resume)},
        {"Output", "--junit", "FILE",
         "Also write the result to FILE as JUnit XML, one test case per row, of 'judge' one per kind of fault; '-' "
         "means standard output, instead of the table. Default: none.",
         sharing | bit(Verb::merge) | bit(Verb::judge), false, set_path("--junit", &Options::junit),
         usual_for(bit(Verb::check) | bit(Verb::merge) | bit(Verb::judge), "also as JUnit XML")},
    };
}

} // namespace tetrace
