// Fuzzing XMP packets of drone cameras. Invariant for any bytes: an invalid packet gives a status of formats.h and an
// error text, and delivers no entry; otherwise the falloff is a valid profile or marked unusable with the reason.
#include "fuzz_import.hpp"

#include "formats/each_format.h"

namespace {

const char *const kTarget = "fuzz_drone_xmp";

bool try_bytes(const std::vector<char> &text) {
    Visited visited;
    lensprof_error error{};
    const lensprof_status status = lp_drone_xmp_read(text.data(), text.size(), 60, 40, "fuzz", visit, &visited, &error);
    check_reading(status, error, visited,
                  {LENSPROF_ERROR_SYNTAX, LENSPROF_ERROR_SIZE, LENSPROF_ERROR_NOT_FOUND, LENSPROF_ERROR_NOT_FINITE,
                   LENSPROF_ERROR_VIGNETTING});
    return status == LENSPROF_OK;
}

const std::vector<std::string> kWords = [] {
    std::vector<std::string> words = kXmlWords;
    for (const char *word : {"</rdf:li>", "<rdf:li>", "<rdf:Seq>", "</rdf:Seq>", "DJI", "Sentera", "Sentera:", "0,0",
                             "xmlns:Camera=\"\"", "2D"})
        words.push_back(word);
    return words;
}();

}  // namespace
