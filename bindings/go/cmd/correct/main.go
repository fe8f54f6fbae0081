// Corrects a tile of 8 bit or a frame of 16 bit RGB, packs a blob again, or looks a profile up.
//
// usage: correct tile BLOB FRAME_WIDTH FRAME_HEIGHT X Y WIDTH HEIGHT <pixels >corrected
//
//	correct frame BLOB WIDTH HEIGHT <pixels >corrected
//	correct repack BLOB >blob
//	correct closed DATABASE
//	correct lookup DATABASE MAKER MODEL LENS FOCAL_MM APERTURE
package main

import (
	"encoding/binary"
	"errors"
	"fmt"
	"io"
	"os"
	"strconv"

	"lensprof"
)

func correctTile(arguments []string) error {
	blob, err := os.ReadFile(arguments[0])
	if err != nil {
		return err
	}
	var numbers []uint32
	for _, text := range arguments[1:] {
		number, err := strconv.ParseUint(text, 10, 32)
		if err != nil {
			return err
		}
		numbers = append(numbers, uint32(number))
	}
	plan, err := lensprof.NewPlanOfBlob[uint8](blob, lensprof.RGB, numbers[0], numbers[1])
	if err != nil {
		return err
	}
	defer plan.Close()
	pixels, err := io.ReadAll(os.Stdin)
	if err != nil {
		return err
	}
	tile := lensprof.Tile{X: numbers[2], Y: numbers[3], Width: numbers[4], Height: numbers[5]}
	if err := plan.Apply(pixels, tile); err != nil {
		return err
	}
	_, err = os.Stdout.Write(pixels)
	return err
}

func readProfile(path string) (*lensprof.Profile, error) {
	blob, err := os.ReadFile(path)
	if err != nil {
		return nil, err
	}
	return lensprof.Unpack(blob)
}

func correctFrame(arguments []string) error {
	profile, err := readProfile(arguments[0])
	if err != nil {
		return err
	}
	width, err := strconv.ParseUint(arguments[1], 10, 32)
	if err != nil {
		return err
	}
	height, err := strconv.ParseUint(arguments[2], 10, 32)
	if err != nil {
		return err
	}
	plan, err := lensprof.NewPlan[uint16](profile, lensprof.RGB, uint32(width), uint32(height))
	if err != nil {
		return err
	}
	defer plan.Close()
	pixels := make([]uint16, width*height*3)
	if err := binary.Read(os.Stdin, binary.NativeEndian, pixels); err != nil {
		return err
	}
	if err := plan.Apply(pixels, lensprof.Tile{Width: uint32(width), Height: uint32(height)}); err != nil {
		return err
	}
	return binary.Write(os.Stdout, binary.NativeEndian, pixels)
}

func repack(arguments []string) error {
	profile, err := readProfile(arguments[0])
	if err != nil {
		return err
	}
	packed, err := profile.Pack()
	if err != nil {
		return err
	}
	_, err = os.Stdout.Write(packed)
	return err
}

func lookUp(arguments []string) error {
	store, err := lensprof.OpenStore(arguments[0])
	if err != nil {
		return err
	}
	defer store.Close()
	key := lensprof.NewKey()
	key.CameraMaker, key.CameraModel, key.Lens = arguments[1], arguments[2], arguments[3]
	if key.FocalMM, err = strconv.ParseFloat(arguments[4], 64); err != nil {
		return err
	}
	if key.Aperture, err = strconv.ParseFloat(arguments[5], 64); err != nil {
		return err
	}
	found, err := store.Lookup(key)
	if err != nil {
		return err
	}
	exact := 0
	if found.Exact {
		exact = 1
	}
	of := found.Profile.Key()
	fmt.Printf("%s, %.1f mm, f/%.1f: corner %.4f, profiles %d, exact %d\n", of.Lens, of.FocalMM, of.Aperture,
		found.Profile.CornerFalloff(), found.Profiles, exact)
	return nil
}

// useClosed shows what a call on a closed database gives: an error that is lensprof.Argument.
func useClosed(arguments []string) error {
	store, err := lensprof.OpenStore(arguments[0])
	if err != nil {
		return err
	}
	store.Close()
	store.Close()
	_, err = store.Lookup(lensprof.NewKey())
	var failed *lensprof.Error
	if !errors.Is(err, lensprof.Argument) || errors.Is(err, lensprof.NotFound) || !errors.As(err, &failed) {
		return errors.New("the error has another kind")
	}
	return fmt.Errorf("%s (%w)", failed.Text, failed.Status)
}

func main() {
	err := errors.New("usage: correct tile|frame|repack|closed|lookup ...; see the head of main.go")
	if len(os.Args) == 9 && os.Args[1] == "tile" {
		err = correctTile(os.Args[2:])
	} else if len(os.Args) == 5 && os.Args[1] == "frame" {
		err = correctFrame(os.Args[2:])
	} else if len(os.Args) == 3 && os.Args[1] == "repack" {
		err = repack(os.Args[2:])
	} else if len(os.Args) == 3 && os.Args[1] == "closed" {
		err = useClosed(os.Args[2:])
	} else if len(os.Args) == 8 && os.Args[1] == "lookup" {
		err = lookUp(os.Args[2:])
	}
	if err != nil {
		fmt.Fprintln(os.Stderr, err)
		os.Exit(1)
	}
}
