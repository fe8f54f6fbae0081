#include "cli/correct/model_options.hpp"

#include "cli/profiles/key_options.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/response_words.hpp"

namespace lensprof {

void declare_model(Command &command, ModelOptions &o) {
    command.word(
        "--profile", "ID|auto",
        [&o](const std::string &word) {
            o.from_db = word == "auto";
            o.profile = o.from_db ? 0 : profile_id_of(word);
        },
        "use the profile with this id, or look up the profile of each picture by its EXIF (auto; default if nothing "
        "else is given and a database exists); between stored settings the falloff is predicted, as by `lensprof "
        "query`");
    declare_databases(command, o.dbs, "; --profile refers to the first");
    declare_lookup(declare_key_filter(command, o.key), o.lookup);
}

void declare_model_keys(Keys &keys, ModelOptions &o) {
    keys.word(
        "response", "RESPONSE",
        [&o](const std::string &word) {
            o.response.reset();
            if (word != "auto") o.response = response_of_word(word);
        },
        "response of the pictures: auto (default: that of the profile), srgb, gamma:G, linear, film, emor:a,b,... "
        "(EMoR coefficients) or a file (pcalib.txt)");
    keys.flag("force-falloff", o.force_falloff,
              "correct the falloff even if the metadata state that it was corrected before, by lensprof (mark in the "
              "XMP), the camera (maker notes; phones) or a raw converter");
}

void declare_writing(Command &command, CorrectionKind &kind) {
    command.flag("--overwrite", kind.overwrite, "replace existing files even if they were made from other pictures");
    command.expert().count("--threads", kind.threads, 0, 1024,
                           "number of threads that correct pictures; default 0 = all cores");
}

}  // namespace lensprof
