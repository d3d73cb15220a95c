//! Pictures as PNG files (ISO/IEC 15948): red, green and blue, 8 bits each.
//! Written whole, so that a viewer that follows a run never meets half a picture.

use super::deflate::zlib;
use super::write_whole;
use crate::error::{Problem, Result};
use std::path::Path;

/// The most pixels along a side, which keeps a typing error from filling the memory.
pub const LARGEST: usize = 16_384;

/// Writes a picture, row by row from the upper left pixel, three bytes a pixel: red, green, blue.
/// A file of that name is replaced in one stroke.
///
/// ```no_run
/// let red_to_black = (0..=255).rev().flat_map(|red| [red, 0, 0]);
/// meshfree::output::png::write("out/line.png", 256, 1, &red_to_black.collect::<Vec<u8>>())?;
/// # Ok::<(), meshfree::error::Error>(())
/// ```
///
/// # Errors
/// When a side is not between 1 and [`LARGEST`], the number of bytes is not that of the pixels, or
/// the file cannot be written.
pub fn write(path: impl AsRef<Path>, width: usize, height: usize, rgb: &[u8]) -> Result<()> {
    check_size(width, height)?;
    if rgb.len() != 3 * width * height {
        let problem = Problem::Incompatible {
            what: format!(
                "{} bytes do not make a picture of {width} by {height} pixels",
                rgb.len()
            ),
            remedy: "give red, green and blue of each pixel",
        };
        return Err(problem.into());
    }
    write_whole(path.as_ref(), &encode(width, height, rgb))
}

/// Refuses a picture without pixels, or with too many.
pub(super) fn check_size(width: usize, height: usize) -> Result<()> {
    for (what, value) in [("width", width), ("height", height)] {
        if !(1..=LARGEST).contains(&value) {
            let problem = Problem::Parameter {
                what: format!("the {what} of the picture"),
                value: value as f64,
                must_be: "it must be from 1 to 16384 pixels",
            };
            return Err(problem.into());
        }
    }
    Ok(())
}

/// The file of a picture whose size and bytes agree.
pub(super) fn encode(width: usize, height: usize, rgb: &[u8]) -> Vec<u8> {
    // Each row begins with how it is filtered: 0 is not at all, which suits areas of few colours.
    let rows = rgb.chunks(3 * width);
    let rows: Vec<u8> = rows.flat_map(|row| [&[0], row].concat()).collect();
    let mut header = [0; 13];
    header[..4].copy_from_slice(&(width as u32).to_be_bytes());
    header[4..8].copy_from_slice(&(height as u32).to_be_bytes());
    // 8 bits, colours without a palette.
    header[8..10].copy_from_slice(&[8, 2]);
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut file, *b"IHDR", &header);
    chunk(&mut file, *b"IDAT", &zlib(&rows));
    chunk(&mut file, *b"IEND", &[]);
    file
}

/// Appends a chunk: length, kind, content, checksum of kind and content.
fn chunk(file: &mut Vec<u8>, kind: [u8; 4], content: &[u8]) {
    file.extend((content.len() as u32).to_be_bytes());
    let start = file.len();
    file.extend(kind);
    file.extend(content);
    let sum = crc32(&file[start..]);
    file.extend(sum.to_be_bytes());
}

/// What each byte does to the checksum.
const CRC_TABLE: [u32; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut rest = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            rest = if rest & 1 == 1 {
                rest >> 1 ^ 0xedb8_8320
            } else {
                rest >> 1
            };
            bit += 1;
        }
        table[byte] = rest;
        byte += 1;
    }
    table
};

/// The checksum of chunks.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc: u32, &byte| {
        CRC_TABLE[usize::from(crc as u8 ^ byte)] ^ crc >> 8
    })
}

#[cfg(test)]
mod tests {
    use super::super::deflate::tests::unzlib;
    use super::super::tests::Folder;
    use super::*;
    use std::fs;

    #[test]
    fn checksums_are_the_known_ones() {
        // The check value of CRC-32, and the last bytes of every PNG file.
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        assert!(encode(1, 1, &[0; 3]).ends_with(b"\0\0\0\0IEND\xae\x42\x60\x82"));
    }

    #[test]
    fn pictures_come_back() {
        let folder = Folder::new("png");
        let path = folder.file("a.png");
        let (width, height) = (37, 21);
        let rgb: Vec<u8> = (0..3 * width * height)
            .map(|i| (i * i / 50) as u8)
            .collect();
        write(&path, width, height, &rgb).unwrap();
        let file = fs::read(&path).unwrap();
        let mut rest = file.strip_prefix(b"\x89PNG\r\n\x1a\n").unwrap();
        let mut chunks = Vec::new();
        while !rest.is_empty() {
            let length = u32::from_be_bytes(rest[..4].try_into().unwrap()) as usize;
            chunks.push((&rest[4..8], &rest[8..8 + length]));
            rest = &rest[12 + length..];
        }
        let kinds: Vec<_> = chunks.iter().map(|chunk| chunk.0).collect();
        assert_eq!(kinds, [b"IHDR", b"IDAT", b"IEND"]);
        assert_eq!(chunks[0].1, [0, 0, 0, 37, 0, 0, 0, 21, 8, 2, 0, 0, 0]);
        let rows = unzlib(chunks[1].1);
        let rows: Vec<_> = rows.chunks(1 + 3 * width).collect();
        assert!(rows.iter().all(|row| row[0] == 0));
        let read: Vec<u8> = rows.iter().flat_map(|row| &row[1..]).copied().collect();
        assert_eq!(read, rgb);
    }

    #[test]
    fn sizes_that_do_not_fit_are_refused() {
        let folder = Folder::new("png-size");
        let path = folder.file("a.png");
        for (width, height, bytes, says) in [
            (0, 5, 0, "width of the picture is 0"),
            (5, 20_000, 300_000, "height of the picture is 20000"),
            (2, 2, 11, "11 bytes do not make a picture of 2 by 2 pixels"),
        ] {
            let error = write(&path, width, height, &vec![0; bytes]).unwrap_err();
            assert!(error.to_string().contains(says), "{error}");
        }
        assert!(!path.exists());
    }
}
