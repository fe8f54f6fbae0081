package lensprof

// #include <lensprof/lensprof.h>
import "C"

import (
	"fmt"
	"unsafe"
)

// Status is the kind of an error. It is an error itself, so that errors.Is(err, lensprof.NotFound) works.
type Status int

// The statuses that callers most often distinguish; lensprof/base.h has all of them.
const (
	Argument    = Status(C.LENSPROF_ERROR_ARGUMENT)
	Size        = Status(C.LENSPROF_ERROR_SIZE)
	Memory      = Status(C.LENSPROF_ERROR_MEMORY)
	NotFound    = Status(C.LENSPROF_ERROR_NOT_FOUND)
	Corrupt     = Status(C.LENSPROF_ERROR_CORRUPT)
	Layout      = Status(C.LENSPROF_ERROR_LAYOUT) // written by a newer lensprof
	Busy        = Status(C.LENSPROF_ERROR_BUSY)
	Unsupported = Status(C.LENSPROF_ERROR_UNSUPPORTED)
)

// Error is the name of the status in C.
func (s Status) Error() string { return C.GoString(C.lensprof_status_name(C.lensprof_status(s))) }

// Error is a call that the library refused, or that failed.
type Error struct {
	Status Status
	Text   string // a sentence that names the item and the next step
}

func (e *Error) Error() string { return fmt.Sprintf("%s (%v)", e.Text, e.Status) }

// Unwrap gives the status to errors.Is.
func (e *Error) Unwrap() error { return e.Status }

// check makes the error of a call, of the library's text or, if it has none, of the given one.
func check(status C.lensprof_status, failed *C.lensprof_error, text string) error {
	if status == C.LENSPROF_OK {
		return nil
	}
	if failed != nil && failed.text[0] != 0 {
		text = C.GoString(&failed.text[0])
	}
	return &Error{Status(status), text}
}

// checkBlob makes the error of a call that read a blob.
func checkBlob(status C.lensprof_status, failed *C.lensprof_error, bytes int) error {
	item := fmt.Sprintf("profile blob of %d bytes: ", bytes)
	if status != C.LENSPROF_OK && bytes == 0 {
		status = C.LENSPROF_ERROR_CORRUPT
	}
	switch status {
	case C.LENSPROF_ERROR_LAYOUT:
		return &Error{Layout, item + "written by a newer lensprof; update this library"}
	case C.LENSPROF_ERROR_CORRUPT:
		return &Error{Corrupt, item + "not a blob, or damaged; export it again"}
	}
	return check(status, failed, item+"cannot be read")
}

// putText copies a text to an array of C, which is zero before.
func putText(to []C.char, text string) error {
	if len(text) >= len(to) {
		return &Error{Argument, fmt.Sprintf("%q: has more than %d bytes; shorten it", text, len(to)-1)}
	}
	for i := 0; i < len(text); i++ {
		if text[i] == 0 {
			return &Error{Argument, fmt.Sprintf("%q: has a zero; remove it", text)}
		}
		to[i] = C.char(text[i])
	}
	return nil
}

// pointerTo is the address of the first byte; nil if there is none.
func pointerTo(bytes []byte) unsafe.Pointer { return unsafe.Pointer(unsafe.SliceData(bytes)) }
