//! Corrects a tile of 8 bit or a frame of 16 bit RGB, packs a blob again, or looks a profile up.
//!
//! usage: correct tile BLOB FRAME_WIDTH FRAME_HEIGHT X Y WIDTH HEIGHT <pixels >corrected
//!        correct frame BLOB WIDTH HEIGHT <pixels >corrected
//!        correct repack BLOB >blob
//!        correct lookup DATABASE MAKER MODEL LENS FOCAL_MM APERTURE
use lensprof::{Key, Layout, Plan, Profile, Store, Tile};
use std::error::Error;
use std::io::{Read, Write};

fn tile(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let blob = std::fs::read(&arguments[0])?;
    let numbers = arguments[1..]
        .iter()
        .map(|text| text.parse())
        .collect::<Result<Vec<u32>, _>>()?;
    let plan = Plan::<u8>::of_blob(&blob, Layout::Rgb, numbers[0], numbers[1])?;
    let mut pixels = Vec::new();
    std::io::stdin().read_to_end(&mut pixels)?;
    plan.apply(
        &mut pixels,
        Tile {
            x: numbers[2],
            y: numbers[3],
            width: numbers[4],
            height: numbers[5],
        },
    )?;
    Ok(std::io::stdout().write_all(&pixels)?)
}

fn frame(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let profile = Profile::unpack(&std::fs::read(&arguments[0])?)?;
    let (width, height) = (arguments[1].parse()?, arguments[2].parse()?);
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes)?;
    let mut pixels: Vec<u16> = bytes
        .chunks_exact(2)
        .map(|two| u16::from_ne_bytes([two[0], two[1]]))
        .collect();
    let plan = Plan::<u16>::new(&profile, Layout::Rgb, width, height)?;
    plan.apply(
        &mut pixels,
        Tile {
            x: 0,
            y: 0,
            width,
            height,
        },
    )?;
    let corrected: Vec<u8> = pixels.iter().flat_map(|sample| sample.to_ne_bytes()).collect();
    Ok(std::io::stdout().write_all(&corrected)?)
}

fn repack(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let profile = Profile::unpack(&std::fs::read(&arguments[0])?)?;
    Ok(std::io::stdout().write_all(&profile.pack()?)?)
}

fn lookup(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let store = Store::open(&arguments[0])?;
    let found = store.lookup(&Key {
        camera_maker: arguments[1].clone(),
        camera_model: arguments[2].clone(),
        lens: arguments[3].clone(),
        focal_mm: Some(arguments[4].parse()?),
        aperture: Some(arguments[5].parse()?),
        ..Key::default()
    })?;
    let key = found.profile.key();
    println!(
        "{}, {:.1} mm, f/{:.1}: corner {:.4}, profiles {}, exact {}",
        key.lens,
        key.focal_mm.unwrap_or(-1.0),
        key.aperture.unwrap_or(-1.0),
        found.profile.corner_falloff().0,
        found.profiles,
        found.exact as i32
    );
    Ok(())
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match (arguments.first().map(String::as_str), arguments.len()) {
        (Some("tile"), 8) => tile(&arguments[1..]),
        (Some("frame"), 4) => frame(&arguments[1..]),
        (Some("repack"), 2) => repack(&arguments[1..]),
        (Some("lookup"), 7) => lookup(&arguments[1..]),
        _ => Err("usage: correct tile|frame|repack|lookup ...; see the head of correct.rs".into()),
    };
    if let Err(error) = done {
        eprintln!("{error}");
        std::process::exit(1);
    }
}
