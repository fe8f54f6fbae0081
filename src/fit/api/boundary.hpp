// Where exceptions end.
#pragma once

#include <exception>
#include <new>

#include "fit/base/fail.hpp"
#include "fit/base/parallel.hpp"

namespace lensprof {

// Runs a call of the C interface, which returns a status, and converts exceptions to status codes; `what` begins the
// text of an error.
template <class Call>
lensprof_status at_boundary(const char *what, lensprof_error *error, Call call) {
    try {
        return call();
    } catch (const Cancelled &) {
        return fail(LENSPROF_ERROR_CANCELLED, error, "%s: cancelled", what);
    } catch (const std::bad_alloc &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "%s: out of memory", what);
    } catch (const std::exception &e) {
        return fail(LENSPROF_ERROR_INTERNAL, error, "%s: %s", what, e.what());
    } catch (...) {
        return fail(LENSPROF_ERROR_INTERNAL, error, "%s: an unknown exception", what);
    }
}

}  // namespace lensprof
