package lensprof

// #include <lensprof/lensprof.h>
// #include <stdlib.h>
import "C"

import (
	"fmt"
	"runtime"
	"unsafe"
)

// PixelLayout is the order of the samples of a pixel.
type PixelLayout uint32

const (
	Grey = PixelLayout(C.LENSPROF_LAYOUT_GREY)
	RGB  = PixelLayout(C.LENSPROF_LAYOUT_RGB)
	RGBA = PixelLayout(C.LENSPROF_LAYOUT_RGBA)
	BGR  = PixelLayout(C.LENSPROF_LAYOUT_BGR)
	BGRA = PixelLayout(C.LENSPROF_LAYOUT_BGRA)
)

// Sample is a type of samples.
type Sample interface{ uint8 | uint16 | float32 }

// Tile is a part of a frame, px.
type Tile struct{ X, Y, Width, Height uint32 }

// Plan corrects falloff in the pixels of frames of one size. Several goroutines may use it on different tiles; Close
// releases its memory.
type Plan[S Sample] struct {
	memory unsafe.Pointer // of C, as the library keeps pointers into it
	plan   *C.lensprof_plan
	layout PixelLayout
}

// NewPlan prepares a profile for frames of width x height px.
func NewPlan[S Sample](profile *Profile, layout PixelLayout, width, height uint32) (*Plan[S], error) {
	options := newOptions[S](layout, width, height)
	var pinner runtime.Pinner // the options point into the profile
	pinner.Pin(profile)
	defer pinner.Unpin()
	raw := (*C.lensprof_profile)(profile.pointer())
	const text = "this profile: cannot be applied"
	if err := check(C.lensprof_apply_options_set_profile(options, raw), nil, text); err != nil {
		return nil, err
	}
	plan, status, failed := prepare[S](options)
	return plan, check(status, &failed, text)
}

// NewPlanOfBlob prepares a blob, which is read in place.
func NewPlanOfBlob[S Sample](blob []byte, layout PixelLayout, width, height uint32) (*Plan[S], error) {
	if len(blob) == 0 {
		return nil, checkBlob(C.LENSPROF_ERROR_CORRUPT, nil, 0)
	}
	options := newOptions[S](layout, width, height)
	var pinner runtime.Pinner
	pinner.Pin(&blob[0])
	defer pinner.Unpin()
	options.blob, options.blob_bytes = pointerTo(blob), C.size_t(len(blob))
	plan, status, failed := prepare[S](options)
	return plan, checkBlob(status, &failed, len(blob))
}

func sampleType[S Sample]() C.uint32_t {
	var sample S
	switch any(sample).(type) {
	case uint8:
		return C.LENSPROF_SAMPLE_U8
	case uint16:
		return C.LENSPROF_SAMPLE_U16
	}
	return C.LENSPROF_SAMPLE_F32
}

func newOptions[S Sample](layout PixelLayout, width, height uint32) *C.lensprof_apply_options {
	options := new(C.lensprof_apply_options)
	C.lensprof_apply_options_init(options)
	options.frame_width, options.frame_height = C.uint32_t(width), C.uint32_t(height)
	options.source_sample, options.target_sample = sampleType[S](), sampleType[S]()
	options.source_layout = C.uint32_t(layout)
	return options
}

func prepare[S Sample](options *C.lensprof_apply_options) (*Plan[S], C.lensprof_status, C.lensprof_error) {
	var failed C.lensprof_error
	bytes := C.lensprof_plan_bytes(options)
	made := &Plan[S]{memory: C.malloc(bytes + 8), layout: PixelLayout(options.source_layout)}
	status := C.lensprof_plan_init(made.memory, bytes+8, options, &made.plan, &failed)
	if status != C.LENSPROF_OK {
		C.free(made.memory)
		return nil, status, failed
	}
	return made, status, failed
}

// Apply corrects a tile in place. Its rows follow each other without gaps.
func (p *Plan[S]) Apply(pixels []S, tile Tile) error {
	text := fmt.Sprintf("%d samples for %+v: the tile must fit the frame and the pixels", len(pixels), tile)
	row := uint64(tile.Width) * uint64(C.lensprof_layout_samples(C.uint32_t(p.layout)))
	if p.plan == nil {
		return &Error{Argument, "this plan is closed; make it again"}
	}
	if len(pixels) == 0 || row*uint64(tile.Height) != uint64(len(pixels)) {
		return &Error{Size, text}
	}
	var pinner runtime.Pinner
	pinner.Pin(&pixels[0])
	defer pinner.Unpin()
	target := C.lensprof_target{data: unsafe.Pointer(&pixels[0]),
		row_bytes: C.ptrdiff_t(row * uint64(unsafe.Sizeof(pixels[0]))), width: C.uint32_t(tile.Width),
		height: C.uint32_t(tile.Height), sample: sampleType[S](), layout: C.uint32_t(p.layout)}
	return check(C.lensprof_apply(p.plan, nil, &target, C.uint32_t(tile.X), C.uint32_t(tile.Y)), nil, text)
}

// Close releases the memory of the plan, which nothing may use any more. It may be called twice.
func (p *Plan[S]) Close() error {
	C.free(p.memory)
	p.memory, p.plan = nil, nil
	return nil
}
