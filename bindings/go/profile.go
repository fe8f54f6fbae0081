// Package lensprof corrects pictures by profiles of lenses: blobs, plans for tiles of pixels, and the profile database.
//
// It compiles against the C headers through cgo, so that it has no tables of its own; pkg-config finds them.
package lensprof

// #cgo pkg-config: lensprof
// #include <lensprof/lensprof.h>
import "C"

import "unsafe"

// Unknown is a number that is not known.
const Unknown = float64(C.LENSPROF_UNKNOWN)

// Version is that of the library, e.g. "0.3.0". The loader finds only one of the minor version of the headers.
func Version() string { return C.GoString(C.lensprof_version()) }

// Processing states what a camera did to its pictures.
type Processing uint32

const (
	Raw       = Processing(C.LENSPROF_PROCESSING_RAW)
	JPEG      = Processing(C.LENSPROF_PROCESSING_JPEG)
	Corrected = Processing(C.LENSPROF_PROCESSING_CORRECTED)
)

// Key is a camera, a lens and a setting. Empty texts and Unknown are unknown; so is a number of 0.
type Key struct {
	CameraMaker, CameraModel, Lens           string
	CropFactor, FocalMM, Aperture, DistanceM float64 // Aperture is the f-number
	Processing                               Processing
}

// NewKey is a key of rendered pictures, of which nothing is known.
func NewKey() Key {
	return Key{CropFactor: Unknown, FocalMM: Unknown, Aperture: Unknown, DistanceM: Unknown, Processing: JPEG}
}

func (k Key) raw() (*C.lensprof_profile_key, error) {
	raw := new(C.lensprof_profile_key)
	C.lensprof_profile_key_init(raw)
	for _, text := range []struct {
		to   []C.char
		from string
	}{{raw.camera_maker[:], k.CameraMaker}, {raw.camera_model[:], k.CameraModel}, {raw.lens[:], k.Lens}} {
		if err := putText(text.to, text.from); err != nil {
			return nil, err
		}
	}
	for _, number := range []struct {
		to   *C.double
		from float64
	}{{&raw.crop_factor, k.CropFactor}, {&raw.focal_mm, k.FocalMM}, {&raw.aperture, k.Aperture},
		{&raw.distance_m, k.DistanceM}} {
		if number.from != 0 {
			*number.to = C.double(number.from)
		}
	}
	raw.processing = C.uint32_t(k.Processing)
	return raw, nil
}

// Profile is the response and the falloff of one camera, lens and setting: 50 kB, in memory of Go.
type Profile struct{ raw C.lensprof_profile }

func newProfile() *Profile {
	profile := new(Profile)
	C.lensprof_profile_init(&profile.raw)
	return profile
}

// Unpack gives the profile of a blob.
func Unpack(blob []byte) (*Profile, error) {
	profile := newProfile()
	status := C.lensprof_profile_unpack(pointerTo(blob), C.size_t(len(blob)), &profile.raw)
	if err := checkBlob(status, nil, len(blob)); err != nil {
		return nil, err
	}
	return profile, nil
}

// Pack gives the profile as a blob, without covariance.
func (p *Profile) Pack() ([]byte, error) {
	const invalid = "this profile: has values out of range; make it again"
	var bytes C.size_t
	if err := check(C.lensprof_profile_pack(&p.raw, 0, nil, 0, &bytes), nil, invalid); err != nil {
		return nil, err
	}
	blob := make([]byte, bytes)
	return blob, check(C.lensprof_profile_pack(&p.raw, 0, pointerTo(blob), bytes, nil), nil, invalid)
}

// Key is the setting of the profile.
func (p *Profile) Key() Key {
	raw := &p.raw.key
	return Key{C.GoString(&raw.camera_maker[0]), C.GoString(&raw.camera_model[0]), C.GoString(&raw.lens[0]),
		float64(raw.crop_factor), float64(raw.focal_mm), float64(raw.aperture), float64(raw.distance_m),
		Processing(raw.processing)}
}

// CornerFalloff is the relative illuminance of green in the corner, or of all channels.
func (p *Profile) CornerFalloff() float64 {
	return float64(C.lensprof_profile_corner_falloff(&p.raw, 1, nil))
}

// pointer is that of C.
func (p *Profile) pointer() unsafe.Pointer { return unsafe.Pointer(&p.raw) }
