// Manual pages and completions, as the build writes them: what they say, and what man and shells
// make of them.

#include "run_command.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Words = std::vector<std::string>;

const Words kCommands{"convert", "voxelize", "fit",   "render", "outline",
                      "info",    "compare",  "merge", "view"};
const char* const kBashCompletion = "/usr/share/bash-completion/bash_completion";

class Manual : public testing::Test {
  protected:
    void SetUp() override {
        const RunResult result = runBandvox({"--write-manual", (mFolder / "manual").string()});
        ASSERT_EQ(result.status, 0) << result.err;
        ASSERT_EQ(result.out + result.err, "");
    }

    std::filesystem::path file(const std::string& name) const { return mFolder / "manual" / name; }
    Words pages() const {
        Words names{file("man/bandvox.1")};
        for (const std::string& c : kCommands) names.push_back(file("man/bandvox-" + c + ".1"));
        return names;
    }
    const std::filesystem::path& folder() const { return mFolder.path(); }

  private:
    TemporaryFolder mFolder;
};

Words linesOf(const std::string& text) {
    Words lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

Words sorted(Words words) {
    std::sort(words.begin(), words.end());
    return words;
}

/// What a page looks like on a terminal of so many columns, in one line, words apart by a space.
std::string shown(const std::string& page, const RunOptions& options) {
    const RunResult result = runProgram({"env", "LC_ALL=C.UTF-8", "MANWIDTH=2000", "MANPAGER=cat",
                                         "MAN_KEEP_FORMATTING=", "man", "-l", page},
                                        options);
    std::istringstream words(result.out);
    std::string text;
    for (std::string word; words >> word;) text += word + ' ';
    return text;
}

/// The options that a help lists, as "--name ARGUMENT".
Words optionsIn(const std::string& help) {
    Words options;
    for (const std::string& line : linesOf(help)) {
        static const std::regex kHead("^  (?:-., |    )(--[a-z-]+(?: [^ ]+)?)");
        std::smatch match;
        if (std::regex_search(line, match, kHead)) options.push_back(match[1]);
    }
    return options;
}

TEST_F(Manual, HasAPageForEachCommand) {
    Words found;
    for (const auto& entry : std::filesystem::directory_iterator(file("man"))) {
        found.push_back(entry.path());
    }
    EXPECT_EQ(sorted(found), sorted(pages()));
}

TEST_F(Manual, SaysWhatTheHelpSays) {
    if (!hasProgram("man")) GTEST_SKIP() << "man is not installed";
    for (const std::string& command : kCommands) {
        SCOPED_TRACE(command);
        const std::string page = shown(file("man/bandvox-" + command + ".1"), {.folder = folder()});
        for (const char* section :
             {"NAME bandvox-", "SYNOPSIS bandvox ", "DESCRIPTION ", "OPTIONS ",
              "EXIT STATUS 0 done", "EXAMPLES bandvox ", "SEE ALSO bandvox(1), bandvox-"}) {
            EXPECT_NE(page.find(section), std::string::npos) << section;
        }
        const std::string help = runBandvox({"help", command}).out;
        const Words options = optionsIn(help);
        EXPECT_GE(options.size(), 9u);
        for (const std::string& option : options) {
            EXPECT_NE(page.find(option + ' '), std::string::npos) << option;
        }
        // All its words, in whatever lines.
        std::istringstream words(
            help.substr(help.find('\n'), help.find("\nArguments") - help.find('\n')));
        std::string detail;
        for (std::string word; words >> word;) detail += word + ' ';
        EXPECT_NE(page.find(detail), std::string::npos) << detail;
    }
}

TEST_F(Manual, IsReadWithoutWarnings) {
    if (!hasProgram("man")) GTEST_SKIP() << "man is not installed";
    for (const std::string& page : pages()) {
        for (const char* locale : {"LC_ALL=C", "LC_ALL=C.UTF-8"}) {
            const RunResult result = runProgram({"env", locale, "MANROFFSEQ=", "MANWIDTH=80",
                                                 "MANPAGER=cat", "man", "--warnings", "-l", page},
                                                {.folder = folder()});
            EXPECT_EQ(result.status, 0);
            EXPECT_EQ(result.err, "") << page;
        }
    }
}

/// What Markdown shows of a text whose punctuation is escaped.
std::string unescaped(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\' && i + 1 < text.size()) ++i;
        out += text[i];
    }
    return out;
}

TEST_F(Manual, HasPagesOfTheSiteThatSayWhatTheHelpSays) {
    const std::string overview = unescaped(readText(file("markdown/bandvox.md")));
    for (const std::string& command : kCommands) {
        SCOPED_TRACE(command);
        EXPECT_NE(overview.find("[" + command + "](bandvox-" + command + ".md)"),
                  std::string::npos);
        const std::string page = unescaped(readText(file("markdown/bandvox-" + command + ".md")));
        const std::string help = runBandvox({"help", command}).out;
        int found = 0;
        for (const std::string& option : optionsIn(help)) {
            for (const std::string& line : linesOf(page)) {
                if (line.starts_with("````{option} ") && line.ends_with(option)) ++found;
            }
        }
        EXPECT_EQ(found, static_cast<int>(optionsIn(help).size()));
        // All its words, in whatever lines.
        std::istringstream words(
            help.substr(help.find('\n'), help.find("\nArguments") - help.find('\n')));
        std::string detail;
        for (std::string word; words >> word;) detail += (detail.empty() ? "" : " ") + word;
        EXPECT_NE(page.find(detail), std::string::npos) << detail;
    }
}

TEST_F(Manual, FailsWhereItCannotWrite) {
    writeText(folder() / "file", "");
    const RunResult result = runBandvox({"--write-manual", (folder() / "file").string()});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1);
}

/// What bash offers for the last of the words, split as readline does: at = and :, too.
class BashCompletion : public Manual {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(kBashCompletion)) {
            GTEST_SKIP() << "bash-completion is not installed";
        }
        Manual::SetUp();
        std::filesystem::create_directories(work() / "scans");
        for (const char* name : {"bunny.obj", "a.vdb", "notes.md", "surface.SVG", "settings"}) {
            writeText(work() / name, "");
        }
    }

    std::filesystem::path work() const { return folder() / "work"; }

    Words offered(const Words& words) const {
        std::string line, list;
        for (std::size_t i = 0; i < words.size(); ++i) {
            const bool glued = i > 0 && (words[i] == "=" || words[i] == ":" ||
                                         words[i - 1] == "=" || words[i - 1] == ":");
            line += i == 0 || glued ? words[i] : ' ' + words[i];
            list += " '" + words[i] + "'";
        }
        const std::string script = std::string("source ") + kBashCompletion + "\nsource '" +
                                   file("bash/bandvox").string() +
                                   "'\n"
                                   "compopt() { :; }\n"  // works in a line editor alone
                                   "COMP_WORDS=(" +
                                   list + ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
                                   "\nCOMP_LINE='" + line +
                                   "'\nCOMP_POINT=${#COMP_LINE}\nCOMP_TYPE=9\n"
                                   "COMP_WORDBREAKS=$' \\t\\n\"\\'><=;|&(:'\n"
                                   "_bandvox bandvox \"${COMP_WORDS[COMP_CWORD]}\"\n"
                                   "((${#COMPREPLY[@]})) && printf '%s\\n' \"${COMPREPLY[@]}\"\n"
                                   "exit 0\n";
        const RunResult result = runProgram({"bash", "--norc", "-c", script}, {.folder = work()});
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err, "");
        return sorted(linesOf(result.out));
    }
};

TEST_F(BashCompletion, KnowsTheCommands) {
    Words all = kCommands;
    for (const char* other : {"help", "--help", "--version"}) all.emplace_back(other);
    EXPECT_EQ(offered({"bandvox", ""}), sorted(all));
    EXPECT_EQ(offered({"bandvox", "conv"}), Words{"convert"});
    EXPECT_EQ(offered({"bandvox", "help", "v"}), (Words{"view", "voxelize"}));
    EXPECT_EQ(offered({"bandvox", "help", "view", ""}), Words{});
    EXPECT_EQ(offered({"bandvox", "nonsense", ""}), Words{});
}

TEST_F(BashCompletion, KnowsTheOptionsOfEachCommand) {
    for (const std::string& command : kCommands) {
        Words names;
        for (const std::string& option : optionsIn(runBandvox({"help", command}).out)) {
            names.push_back(option.substr(0, option.find(' ')));
        }
        EXPECT_EQ(offered({"bandvox", command, "--"}), sorted(names)) << command;
    }
    EXPECT_EQ(offered({"bandvox", "render", "a.vdb", "--samp"}), Words{"--samples"});
}

TEST_F(BashCompletion, KnowsTheWordsOfOptions) {
    const Words routes{"auto", "exact", "sampled", "winding"};
    EXPECT_EQ(offered({"bandvox", "convert", "--route", ""}), routes);
    EXPECT_EQ(offered({"bandvox", "convert", "--route", "=", ""}), routes);
    EXPECT_EQ(offered({"bandvox", "convert", "--route", "=", "e"}), Words{"exact"});
    EXPECT_EQ(offered({"bandvox", "outline", "--kinds", "crease,co"}), Words{"crease,contour"});
    EXPECT_EQ(offered({"bandvox", "convert", "--resolution", ""}), Words{});
    EXPECT_EQ(offered({"bandvox", "convert", "-r", ""}), Words{});
}

TEST_F(BashCompletion, KnowsTheShapesInSpiteOfTheColon) {
    EXPECT_EQ(offered({"bandvox", "convert", "sha"}).size(), 6u);
    EXPECT_EQ(offered({"bandvox", "convert", "shape", ":", "to"}), Words{"torus"});
}

TEST_F(BashCompletion, KnowsHowFilesEnd) {
    EXPECT_EQ(offered({"bandvox", "convert", "-o", ""}), (Words{"a.vdb", "bunny.obj", "scans"}));
    EXPECT_EQ(offered({"bandvox", "merge", "a.vdb", ""}), (Words{"a.vdb", "scans"}));
    EXPECT_EQ(offered({"bandvox", "outline", "--output", ""}), (Words{"scans", "surface.SVG"}));
    EXPECT_EQ(offered({"bandvox", "info", "b"}), Words{"bunny.obj"});
    EXPECT_EQ(offered({"bandvox", "info", "--config", "se"}), Words{"settings"});
    EXPECT_EQ(offered({"bandvox", "info", "n"}), Words{});
}

TEST_F(BashCompletion, OffersOnlyWordsThatAreTaken) {
    // Errors of usage come before the folder is missed; those of a wrong word name the option.
    for (const char* option :
         {"--route", "--overlap", "--as", "--compression", "--points", "--progress"}) {
        const Words words = offered({"bandvox", "convert", option, ""});
        EXPECT_GE(words.size(), 2u) << option;
        for (const std::string& word : words) {
            const RunResult result = runBandvox({"convert", "shape:cube", "-o", "/nowhere/a.vdb",
                                                 option, word, "--resolution", "8"});
            EXPECT_EQ(result.err.find(std::string("option ") + option), std::string::npos)
                << result.err;
        }
    }
}

TEST_F(Manual, CompletesInFish) {
    if (!hasProgram("fish")) GTEST_SKIP() << "fish is not installed";
    writeText(folder() / "bunny.obj", "");
    writeText(folder() / "notes.md", "");
    const auto offered = [&](const std::string& line) {
        const RunResult result = runProgram(
            {"env", "HOME=" + folder().string(), "fish", "--no-config", "-c",
             "source '" + file("fish/bandvox.fish").string() + "'; complete -C '" + line + "'"},
            {.folder = folder()});
        EXPECT_EQ(result.err, "") << line;
        Words words;
        for (const std::string& found : linesOf(result.out)) {
            words.push_back(found.substr(0, found.find('\t')));
        }
        return sorted(words);
    };
    EXPECT_EQ(offered("bandvox con"), Words{"convert"});
    EXPECT_EQ(offered("bandvox help v"), (Words{"view", "voxelize"}));
    EXPECT_EQ(offered("bandvox convert --route "), (Words{"auto", "exact", "sampled", "winding"}));
    EXPECT_EQ(offered("bandvox outline --kinds crease,co"), Words{"crease,contour"});
    EXPECT_EQ(offered("bandvox render --samp"), Words{"--samples"});
    EXPECT_EQ(offered("bandvox convert shape:to"), Words{"shape:torus"});
    EXPECT_EQ(offered("bandvox info b"), Words{"bunny.obj"});
    EXPECT_EQ(offered("bandvox info n"), Words{});
}

// Types a line into a zsh on a terminal of its own, and tells what its completion adds.
constexpr const char* kZshDriver = R"zsh(
zmodload zsh/zpty
place=$1 line=$2 found=$3
zpty shell zsh -f -i
tell() { zpty -w shell "$1" }
tell "PS1= fpath=(${(q)place} \$fpath)"
tell 'autoload -U compinit; compinit -u -D'
tell 'compadd() { local -a added; builtin compadd -A added "$@"
    ((${#added})) && print -rl -- $added >> '${(q)found}'; builtin compadd "$@" }'
tell 'complete-once() { zle complete-word; print END >> '${(q)found}' }'
tell 'zle -N complete-once; bindkey "^I" complete-once'
zpty -w -n shell "$line"$'\t'
for ((i = 0; i < 300; ++i)) {
    [[ -e $found && "$(< $found)" == *END ]] && break
    sleep 0.1
}
zpty -d shell
)zsh";

TEST_F(Manual, CompletesInZsh) {
    if (!hasProgram("zsh")) GTEST_SKIP() << "zsh is not installed";
    const RunResult checked = runProgram({"zsh", "-f", "-n", file("zsh/_bandvox").string()});
    EXPECT_EQ(checked.status, 0);
    EXPECT_EQ(checked.err, "");
    writeText(folder() / "bunny.obj", "");
    writeText(folder() / "bones.md", "");
    const auto offered = [&](const std::string& line) {
        const std::filesystem::path found = folder() / "found";
        std::filesystem::remove(found);
        runProgram(
            {"zsh", "-f", "-c", kZshDriver, "zsh", file("zsh").string(), line, found.string()},
            {.folder = folder()});
        Words words = linesOf(readText(found));
        if (words.empty() || words.back() != "END") return Words{"never came to an end"};
        words.pop_back();
        // Functions of zsh add some words again when they look for a common beginning.
        words = sorted(words);
        words.erase(std::unique(words.begin(), words.end()), words.end());
        return words;
    };
    EXPECT_EQ(offered("bandvox con"), Words{"convert"});
    EXPECT_EQ(offered("bandvox help v"), (Words{"view", "voxelize"}));
    EXPECT_EQ(offered("bandvox convert --route "), (Words{"auto", "exact", "sampled", "winding"}));
    EXPECT_EQ(offered("bandvox outline --kinds crease,co"), Words{"contour"});
    EXPECT_EQ(offered("bandvox render a.vdb --samp"), Words{"--samples"});
    EXPECT_EQ(offered("bandvox convert shape:to"), Words{"shape:torus"});
    EXPECT_EQ(offered("bandvox convert -o b"), Words{"bunny.obj"});
}

}  // namespace
}  // namespace bandvox::app_test
