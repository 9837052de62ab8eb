#include "cli/program.h"

#include <algorithm>
#include <cstdlib>

#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::test {
namespace {

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

}  // namespace

Result run(const std::filesystem::path& program, const std::vector<std::string>& arguments,
           const std::vector<std::string>& environment) {
    static int count = 0;
    const std::filesystem::path dir = build_dir() / "scratch";
    std::filesystem::create_directories(dir);
    // Several test programs may run at once.
    const std::string name = "cli." + std::to_string(getpid()) + "." + std::to_string(++count);
    const std::filesystem::path out = dir / (name + ".out");
    const std::filesystem::path err = dir / (name + ".err");
    std::string command = "env ";
    for (const std::string& variable : environment)
        command += quoted(variable) + " ";
    command += quoted(program.string());
    for (const std::string& argument : arguments)
        command += " " + quoted(argument);
    command += " >" + quoted(out.string()) + " 2>" + quoted(err.string());
    const int status = std::system(command.c_str());
    Result result;
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.out = read_text(out, "test");
    result.err = read_text(err, "test");
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return result;
}

Result relevo(const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment) {
    static const char* const given = std::getenv("RELEVO_PROGRAM");
    std::vector<std::string> words = arguments;
    const auto capture = std::find_if(words.begin(), words.end(), [](const std::string& word) {
        return word == "capture" || word == "run";
    });
    const bool says_device = std::any_of(words.begin(), words.end(), [](const std::string& word) {
        return word.starts_with("--device");
    });
    if (capture != words.end() && !says_device)
        words.insert(capture + 1, {"--device", gl_device()});
    // Without plugins of the user who runs the tests.
    std::vector<std::string> whole{"XDG_DATA_HOME=/nonexistent", "RELEVO_PLUGIN_PATH="};
    whole.insert(whole.end(), environment.begin(), environment.end());
    return run(given && *given ? std::filesystem::path(given) : build_dir() / "bin/relevo", words,
               whole);
}

Measured measured(std::vector<std::string> arguments) {
    arguments.insert(
        arguments.begin(),
        {"-c",
         "import resource, subprocess, sys\n"
         "status = subprocess.run(sys.argv[1:]).returncode\n"
         "used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
         "print(used.ru_maxrss // 1024, used.ru_utime + used.ru_stime, file=sys.stderr)\n"
         "sys.exit(status if status >= 0 else 128 - status)\n",
         (build_dir() / "bin/relevo").string()});
    Measured result{run("/usr/bin/env", [&] {
        arguments.insert(arguments.begin(), "python3");
        return arguments;
    }())};
    std::string& err = result.run.err;
    const std::size_t line = err.rfind('\n', err.size() - 2) + 1;
    result.peak_mib = std::atoi(err.c_str() + line);
    result.processor_s = std::atof(err.c_str() + err.find(' ', line));
    err.resize(line);
    return result;
}

void expect_failure(const std::vector<std::string>& arguments, int status,
                    const std::string& message) {
    const Result result = relevo(arguments);
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_EQ(result.err, "relevo: error: " + message + "\n");
    EXPECT_EQ(result.out, "");
}

nlohmann::json of_one_day(const nlohmann::json& answer) {
    if (!answer.contains("days") || answer["days"].size() != 1) return answer;
    nlohmann::json all = answer;
    all.erase("days");
    all.update(answer["days"][0]);
    return all;
}

std::string bundled_dem() {
    return (source_dir() / "data/dem/jacksboro.tif").string();
}

}  // namespace relevo::test
