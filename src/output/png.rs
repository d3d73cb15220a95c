//! Pictures as PNG files (ISO/IEC 15948): red, green and blue, 8 bits each, with the feature `pictures`.
//! Written whole, so that a viewer that follows a run never meets half a picture.

use super::picture::check_size;
use super::{file_error, write_whole};
use crate::error::{Problem, Result};
use std::io;
use std::path::Path;

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
/// When a side is not between 1 and [`LARGEST`](super::picture::LARGEST), the number of bytes is not that of the
/// pixels, or the file cannot be written.
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
    let path = path.as_ref();
    let file = encode(width, height, rgb).map_err(io::Error::from);
    write_whole(path, &file.map_err(file_error("write", path))?)
}

/// The file of a picture whose size and bytes agree.
pub(super) fn encode(
    width: usize,
    height: usize,
    rgb: &[u8],
) -> std::result::Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::super::tests::Folder;
    use super::*;
    use std::fs::File;

    #[test]
    fn pictures_come_back() {
        let folder = Folder::new("png");
        let path = folder.file("a.png");
        let (width, height) = (37, 21);
        let rgb: Vec<u8> = (0..3 * width * height)
            .map(|i| (i * i / 50) as u8)
            .collect();
        write(&path, width, height, &rgb).unwrap();
        let decoder = png::Decoder::new(io::BufReader::new(File::open(&path).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut read = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut read).unwrap();
        assert_eq!((info.width, info.height), (37, 21));
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
