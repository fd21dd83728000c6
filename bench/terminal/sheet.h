#pragma once

#include "bench/terminal/table.h"

#include <string>
#include <variant>
#include <vector>

namespace tetrace {

/// How a sheet is printed.
struct SheetStyle {
    /// Columns of the terminal: longer prose is wrapped, and tables leave out columns. 0: not a terminal, and all of it
    /// is printed, prose to 110 columns.
    std::size_t width = 0;
    /// Keys of the columns to show in tables that have any of them, after their first column; empty: all.
    std::vector<std::string> columns = {};
};

/// What a run prints, part after part, as text for a terminal or as Markdown to post.
class Sheet {
public:
    /// A line that names what follows.
    void heading(const std::string& text) { parts_.push_back(Words{Kind::heading, text}); }
    /// A line that is wrapped only if the terminal is narrower. Empty text adds nothing, here and below.
    void line(const std::string& text) { add(Kind::line, text); }
    /// Lines that keep their form: code in Markdown.
    void verbatim(const std::string& lines) { add(Kind::verbatim, lines); }
    /// A paragraph, wrapped.
    void prose(const std::string& text, std::size_t indent = 0) { add(Kind::prose, text, {}, indent); }
    /// A closing line: a label, and a paragraph to its right; an item of a list in Markdown.
    void labelled(const std::string& label, const std::string& text) { add(Kind::labelled, text, label); }
    void table(const Table& table, std::size_t indent = 2) { parts_.push_back(Placed{table, indent}); }
    /// An empty line.
    void gap() { parts_.push_back(Words{Kind::gap, {}}); }
    /// The other's parts after these.
    void append(const Sheet& other) { parts_.insert(parts_.end(), other.parts_.begin(), other.parts_.end()); }

    /// The keys of all tables' columns, each once.
    [[nodiscard]] std::vector<std::string> column_keys() const;

    [[nodiscard]] std::string text(const SheetStyle& style = {}) const;
    [[nodiscard]] std::string markdown(const SheetStyle& style = {}) const;

private:
    enum class Kind { heading, line, verbatim, prose, labelled, gap };
    struct Words {
        Kind kind;
        std::string text;
        std::string label = {};
        std::size_t indent = 0;
    };
    struct Placed {
        Table table;
        std::size_t indent;
    };

    void add(Kind kind, const std::string& text, const std::string& label = {}, std::size_t indent = 0)
    {
        if (!text.empty()) parts_.push_back(Words{kind, text, label, indent});
    }
    [[nodiscard]] static std::string text_of(const Words& words, std::size_t width);
    [[nodiscard]] static std::string markdown_of(const Words& words);

    std::vector<std::variant<Words, Placed>> parts_;
};

} // namespace tetrace
