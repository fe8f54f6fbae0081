#include "cli_runs.hpp"

template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace cli_runs {

Json parsed(const std::string &text) { return Json::parse(text); }

Words operator+(Words words, const Words &more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::string joined(const Words &words) {
    std::string text;
    for (const std::string &word : words) text += word + " ";
    return text;
}

Outcome run_words(const Words &words) {
    std::ostringstream out, err;
    Streams streams{out, err};
    const int code = run(words, streams);
    return {code, out.str(), err.str()};
}

std::string must_exit(int code, const Words &words) {
    const Outcome outcome = run_words(words);
    if (outcome.code != code)
        fail_msg("%s: exit code %d, not %d: %s", joined(words).c_str(), outcome.code, code, outcome.err.c_str());
    return outcome.out;
}

Json json_of(const Words &words, int code) {
    const std::string text = must_exit(code, words);
    assert_int_equal(std::count(text.begin(), text.end(), '\n'), 1);
    const Json json = Json::parse(text, nullptr, false);
    assert_false(json.is_discarded());
    assert_int_equal(json.value("schema", 0), 2);
    return json;
}

std::string code_of(const Json &json) {
    const Json &findings = json.at("findings");
    return findings.empty() ? "none" : findings[0].at("code").get<std::string>();
}

std::string text_of(const Json &json) {
    const Json &findings = json.at("findings");
    return findings.empty() ? "" : findings[0].at("text").get<std::string>();
}

Outcome run_child(const Words &words, const std::function<void()> &prepare) {
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        prepare();
        const Outcome outcome = run_words(words);
        const std::string both = outcome.out + '\0' + outcome.err;
        for (size_t at = 0; at < both.size();) {
            const ssize_t written = write(ends[1], both.data() + at, both.size() - at);
            if (written <= 0) _exit(255);
            at += size_t(written);
        }
        _exit(outcome.code);
    }
    close(ends[1]);
    std::string both;
    char buffer[4096];
    for (ssize_t got; (got = read(ends[0], buffer, sizeof buffer)) > 0;) both.append(buffer, size_t(got));
    close(ends[0]);
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    const size_t middle = std::min(both.find('\0'), both.size());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), both.substr(0, middle),
            both.substr(std::min(middle + 1, both.size()))};
}

Disk disk() {
    Disk all;
    for (const fs::directory_entry &entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().lexically_relative(folder).string();
        if (entry.is_directory())
            all[name + "/"] = Bytes();
        else
            all[name] = load(entry.path().string());
    }
    return all;
}

std::string difference(const Disk &before, const Disk &after) {
    std::string text;
    for (const auto &file : before) {
        const auto same = after.find(file.first);
        if (same == after.end())
            text += " lost " + file.first;
        else if (same->second != file.second)
            text += " changed " + file.first;
    }
    for (const auto &file : after)
        if (!before.count(file.first)) text += " left " + file.first;
    return text;
}

void assert_refusal(const Words &words, const Outcome &outcome, int code, const Words &named, const Disk &before) {
    const std::string what = joined(words);
    if (outcome.code != code)
        fail_msg("%s: exit code %d, not %d: %s", what.c_str(), outcome.code, code, outcome.err.c_str());
    if (outcome.err.rfind("lensprof: ", 0) != 0 || outcome.err.back() != '\n')
        fail_msg("%s: not an error line of lensprof: %s", what.c_str(), outcome.err.c_str());
    for (const std::string &name : named)
        if (!contains(outcome.err, name))
            fail_msg("%s: '%s' does not name %s", what.c_str(), outcome.err.c_str(), name.c_str());
    const std::string changes = difference(before, disk());
    if (!changes.empty()) fail_msg("%s: on the disk:%s", what.c_str(), changes.c_str());
}

void assert_refused(int code, const Words &words, const Words &named) {
    const Disk before = disk();
    const Outcome outcome = run_words(words);
    assert_refusal(words, outcome, code, named, before);
    if (code != not_usable && !outcome.out.empty())
        fail_msg("%s: printed %s", joined(words).c_str(), outcome.out.c_str());
}

std::vector<std::pair<size_t, size_t>> find_pattern(const std::string &pattern, const std::string &text, size_t at) {
    regex_t compiled;
    regmatch_t found[4];
    if (regcomp(&compiled, pattern.c_str(), REG_EXTENDED | REG_NEWLINE) != 0)
        fail_msg("%s is not a regular expression", pattern.c_str());
    std::vector<std::pair<size_t, size_t>> groups;
    if (regexec(&compiled, text.c_str() + at, 4, found, 0) == 0)
        for (const regmatch_t &group : found)
            groups.push_back({at + size_t(std::max(group.rm_so, 0)), size_t(group.rm_eo - group.rm_so)});
    regfree(&compiled);
    return groups;
}

std::string replaced(const std::string &text, const std::string &pattern, const std::string &replacement) {
    std::string result;
    size_t at = 0;
    for (auto match = find_pattern(pattern, text); !match.empty(); match = find_pattern(pattern, text, at)) {
        std::string instead = replacement;
        const size_t group = instead.find("$1");
        if (group != std::string::npos) instead.replace(group, 2, text, match[1].first, match[1].second);
        result.append(text, at, match[0].first - at).append(instead);
        at = match[0].first + match[0].second;
    }
    return result + text.substr(at);
}

std::string text_of(const std::string &path) {
    const Bytes bytes = load(path);
    return std::string(bytes.begin(), bytes.end());
}

void edit(const std::string &path, const std::string &pattern, const std::string &replacement) {
    const std::string text = text_of(path), changed = replaced(text, pattern, replacement);
    if (changed == text) fail_msg("%s: nothing matches %s", path.c_str(), pattern.c_str());
    save(path, Bytes(changed.begin(), changed.end()));
}

std::string lensfun_text(const std::string &lens, const std::vector<LensfunEntry> &entries) {
    std::ostringstream text;
    text << "<lensdatabase version=\"1\"><lens><maker>Example</maker><model>Example " << lens
         << "</model><mount>Generic</mount><cropfactor>1.5</cropfactor><calibration>\n";
    for (const LensfunEntry &e : entries)
        text << "<vignetting model=\"pa\" focal=\"" << e.focal_mm << "\" aperture=\"" << e.aperture << "\" distance=\""
             << e.distance_m << "\" k1=\"" << e.k1 << "\" k2=\"" << e.k2 << "\" k3=\"0\"/>\n";
    text << "</calibration></lens></lensdatabase>\n";
    return text.str();
}

double falloff_error(const Json &k, const std::vector<double> &truth) {
    double worst = 0.0;
    for (double r = 0.0; r <= 1.0; r += 0.05) {
        double difference = 0.0;
        for (int n = 0; n < 3; n++) difference += (k[n].get<double>() - truth[n]) * std::pow(r * r, n + 1);
        worst = std::max(worst, std::abs(difference));
    }
    return worst;
}

std::string copy_of(const std::string &from, const std::string &to) {
    fs::copy(in_folder(from), work(to), fs::copy_options::recursive);
    return work(to);
}

void render(const std::string &name, const Words &words) {
    static std::map<Words, std::string> rendered;
    const auto [entry, is_new] = rendered.try_emplace(words, in_folder("rendered" + std::to_string(rendered.size())));
    if (is_new) must_exit(done, Words{"simulate", "-o", entry->second} + words);
    fs::copy(entry->second, work(name), fs::copy_options::recursive);
}

int make_scene(void **state) {
    umask(022);
    if (make_folder(state) != 0) return -1;
    setenv("XDG_DATA_HOME", in_folder("work/data").c_str(), 1);
    setenv("XDG_DATA_DIRS", in_folder("work/share").c_str(), 1);
    must_exit(done, {"simulate", "-o", in_folder("scene"), "--images", "4", "--size", "320x240", "--set",
                     "test-points=1500"});
    must_exit(done, {"simulate", "-o", in_folder("mixed"), "--images", "6", "--size", "200x150", "--exif", "--format",
                     "png,png16,tiff,tiff16,tiff32,jpeg"});
    return 0;
}

int empty_work(void **) {
    fs::remove_all(work(""));
    fs::create_directories(work(""));
    return 0;
}

}  // namespace cli_runs
