package lensprof

// #include <lensprof/lensprof.h>
// #include <stdlib.h>
import "C"

import (
	"fmt"
	"strings"
	"sync"
	"unsafe"
)

// Store is an open profile database, which is only read. Goroutines that use it wait for each other; Close closes it.
type Store struct {
	mutex sync.Mutex
	store *C.lensprof_store
}

// Found is the answer of a lookup.
type Found struct {
	Profile  *Profile
	Exact    bool    // the answer is a stored profile, unchanged
	Profiles int     // stored profiles used for the falloff
	Sigma    float64 // standard error of the falloff in the corner, or Unknown
	Reason   string  // warnings, as whole sentences
}

// OpenStore opens a database that exists.
func OpenStore(path string) (*Store, error) {
	if strings.ContainsRune(path, 0) {
		return nil, &Error{Argument, fmt.Sprintf("%q: has a zero; no file has such a name", path)}
	}
	name := C.CString(path)
	defer C.free(unsafe.Pointer(name))
	var store *C.lensprof_store
	var failed C.lensprof_error
	status := C.lensprof_store_open(name, C.LENSPROF_STORE_READ, &store, &failed)
	if err := check(status, &failed, path+": cannot be opened"); err != nil {
		return nil, err
	}
	return &Store{store: store}, nil
}

// Lookup gives the profile for a setting: a stored one, or composed of the lens's falloffs at other settings and the
// camera's response. The error is NotFound, with the reason, if nothing is near enough.
func (s *Store) Lookup(key Key) (*Found, error) {
	raw, err := key.raw()
	if err != nil {
		return nil, err
	}
	s.mutex.Lock()
	defer s.mutex.Unlock()
	if s.store == nil {
		return nil, &Error{Argument, "this store is closed; open it again"}
	}
	profile, how, failed := newProfile(), new(C.lensprof_lookup), C.lensprof_error{}
	C.lensprof_lookup_init(how)
	status := C.lensprof_store_lookup(s.store, raw, nil, &profile.raw, how, &failed)
	if err := check(status, &failed, "the lookup failed"); err != nil {
		return nil, err
	}
	return &Found{profile, how.exact != 0, int(how.rows), float64(how.sigma), C.GoString(&how.reason[0])}, nil
}

// Close closes the database. It may be called twice.
func (s *Store) Close() error {
	s.mutex.Lock()
	defer s.mutex.Unlock()
	C.lensprof_store_close(s.store)
	s.store = nil
	return nil
}
