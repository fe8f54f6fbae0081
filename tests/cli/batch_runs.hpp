// Common parts of the tests of many or large pictures: a lens to correct them with.
#pragma once

#include "cli_runs.hpp"

#include <lensprof/store.h>

namespace batch_runs {

using namespace cli_runs;

// A falloff, a response and a gain grid, so that the correction depends on the position of every pixel.
inline std::unique_ptr<lensprof_profile> make_profile_of_lens() {
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    p->vignetting[0].k[0] = -0.4;
    p->vignetting[0].k[1] = 0.1;
    p->grid.columns = 4, p->grid.rows = 3, p->grid.channels = 3;
    for (int i = 0; i < 36; i++) p->grid.attenuation[i] = 0.8f + 0.02f * float(i * 7 % 13);
    return p;
}

inline const std::string &database() {
    static const std::string path = in_folder("lens.db");
    if (!fs::exists(path)) {
        lensprof_store *store = nullptr;
        assert_ok(lensprof_store_open(path.c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
        assert_ok(lensprof_store_put(store, make_profile_of_lens().get(), nullptr, nullptr));
        lensprof_store_close(store);
    }
    return path;
}

inline Words corrected_into(const std::string &out, const Words &more) {
    return Words{"apply", "--profile", "1", "--key", "processing=jpeg", "--db", database(), "-o", work(out)} + more;
}

}  // namespace batch_runs
