//! Films: pictures in the order of time as PNG files, and one animated PNG of them, with the feature `pictures`.
//! A frame is a file as soon as it is drawn, so what was drawn before a crash stays.

use super::picture::Picture;
use super::{file_error, png as own_png, write_whole};
use crate::error::{Error, Problem, Result};
use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

/// A film: frames with title, axes and bar, and at the end one animated PNG, which browsers and slides play.
///
/// ```
/// use meshfree::output::film::Film;
/// use meshfree::output::picture::Picture;
/// use meshfree::prelude::*;
/// use meshfree::run::{Run, Schedule};
/// let water = catalogue::weakly_compressible_water(2.0);
/// let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(Body::block("water", water, [0.0; 2], [0.2, 0.2], 0.02))
///     .wall(Wall::around("tank", [0.0; 2], [0.4, 0.3], 0.02, 3, [[true, true], [true, false]]))
///     .acceleration(|_| [0.0, -9.81])
///     .build()?;
/// # let folder = std::env::temp_dir().join(format!("meshfree-film-{}", std::process::id()));
/// # let path = folder.join("tank.png");
/// # /*
/// let path = "out/tank.png";
/// # */
/// let mut film = Film::new(&path);
/// Run::new(&mut tank, 0.02)
///     .observe(Schedule::every(0.01), |now| {
///         let pressure = Axis::linear("pressure", "Pa").range(0.0, 2000.0);
///         let water = now.all().map(|own| (own.position(), own.pressure()));
///         let picture = Picture::new(400, 300).bounds([0.0; 2], [0.4, 0.3]).edges([0.0; 2], [0.4, 0.3]);
///         film.frame(now.time(), picture.particles(pressure, now.spacing(), water))?;
///         Ok(())
///     })
///     .go()?;
/// film.finish()?;
/// # assert!(path.exists() && folder.join("tank_00002.png").exists());
/// # let _ = std::fs::remove_dir_all(folder);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Film {
    path: PathBuf,
    rate: u16,
    size: Option<[usize; 2]>,
    frames: Vec<PathBuf>,
}

impl Film {
    /// A film without frames, of 25 a second. `path` is that of the animated PNG; frames stand next to it, as `tank_00000.png`
    /// for `tank.png`.
    ///
    /// ```
    /// # use meshfree::output::film::Film;
    /// let film = Film::new("out/tank.png");
    /// assert!(film.is_empty());
    /// ```
    #[must_use]
    pub fn new(path: impl AsRef<Path>) -> Self {
        Self {
            path: path.as_ref().to_path_buf(),
            rate: 25,
            size: None,
            frames: Vec::new(),
        }
    }

    /// Frames a second.
    ///
    /// ```
    /// # use meshfree::output::film::Film;
    /// let slow = Film::new("out/tank.png").rate(10);
    /// # let _ = slow;
    /// ```
    #[must_use]
    pub fn rate(mut self, frames_a_second: u16) -> Self {
        self.rate = frames_a_second;
        self
    }

    /// The number of frames.
    #[must_use]
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there are no frames.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Draws the next frame, of a time \[s\], which is its title unless it has one, and writes it as a file, whose path this is.
    /// All need one size; fix [bounds](Picture::bounds) and the range of the axis too, so that nothing jumps.
    ///
    /// # Errors
    /// Those of [`Picture::page`]; when the size differs from that of the first, or the file cannot be written.
    pub fn frame(&mut self, time: f64, picture: Picture) -> Result<PathBuf> {
        let (width, height, rgb) = picture.or_title(&format!("t = {time:.4} s")).page()?;
        let [w, h] = *self.size.get_or_insert([width, height]);
        if [w, h] != [width, height] {
            let what = format!("a frame of {width} by {height} pixels in a film of {w} by {h}");
            let remedy = "give all pictures of a film the size of the first";
            return Err(Problem::Incompatible { what, remedy }.into());
        }
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let name = format!("{stem}_{:05}.png", self.frames.len());
        let path = self.path.with_file_name(name);
        own_png::write(&path, width, height, &rgb)?;
        self.frames.push(path.clone());
        Ok(path)
    }

    /// Writes the animated PNG (APNG, part of PNG since its third edition, W3C 2025), which repeats for ever, from the files of its
    /// frames.
    ///
    /// # Errors
    /// When the film has no frames or no rate, or a file cannot be read or written.
    pub fn finish(self) -> Result<()> {
        let Some([width, height]) = self.size.filter(|_| self.rate > 0) else {
            let (frames, rate) = (self.frames.len(), self.rate);
            let what = format!("a film of {frames} frames at {rate} frames a second");
            let remedy = "draw one frame at least, and take a rate of one at least";
            return Err(Problem::Incompatible { what, remedy }.into());
        };
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let failed = |error: png::EncodingError| file_error("write", &self.path)(error.into());
        encoder
            .set_animated(self.frames.len() as u32, 0)
            .map_err(failed)?;
        encoder.set_frame_delay(1, self.rate).map_err(failed)?;
        let mut writer = encoder.write_header().map_err(failed)?;
        for path in &self.frames {
            writer.write_image_data(&read(path)?).map_err(failed)?;
        }
        writer.finish().map_err(failed)?;
        write_whole(&self.path, &file)
    }
}

/// The pixels of a frame.
fn read(path: &Path) -> Result<Vec<u8>> {
    let failed = |error: png::DecodingError| -> Error { file_error("read", path)(error.into()) };
    let file = File::open(path).map_err(file_error("read", path))?;
    let mut reader = png::Decoder::new(BufReader::new(file))
        .read_info()
        .map_err(failed)?;
    let size = reader.output_buffer_size();
    let size = size.ok_or_else(|| file_error("read", path)(io::Error::other("it is too large")))?;
    let mut pixels = vec![0; size];
    reader.next_frame(&mut pixels).map_err(failed)?;
    Ok(pixels)
}

#[cfg(test)]
mod tests {
    use super::super::tests::Folder;
    use super::*;
    use crate::output::svg::Axis;

    /// A point that goes from left to right.
    fn picture(at: f64) -> Picture {
        let speed = Axis::linear("speed", "m/s").range(0.0, 1.0);
        let empty = Picture::new(120, 80).bounds([0.0; 2], [1.2, 0.8]);
        empty.particles(speed, 0.2, [([at, 0.4], 0.5)])
    }

    #[test]
    fn a_film_decodes_to_its_frames() {
        let folder = Folder::new("film");
        let path = folder.file("ball.png");
        let mut film = Film::new(&path).rate(10);
        for k in 0..3 {
            film.frame(0.1 * f64::from(k), picture(0.3 * f64::from(k + 1)))
                .unwrap();
        }
        assert_eq!(film.len(), 3);
        let files = film.frames.clone();
        film.finish().unwrap();
        let file = BufReader::new(File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let (width, height, _) = picture(0.5).page().unwrap();
        assert_eq!(
            [reader.info().width, reader.info().height],
            [width as u32, height as u32]
        );
        let animation = reader.info().animation_control().unwrap();
        assert_eq!((animation.num_frames, animation.num_plays), (3, 0));
        let mut frames = Vec::new();
        for file in files {
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            let control = reader.info().frame_control().unwrap();
            assert_eq!((control.delay_num, control.delay_den), (1, 10));
            assert_eq!(
                [control.width, control.height],
                [width as u32, height as u32]
            );
            assert!(pixels == read(&file).unwrap(), "a frame is its file");
            assert!(!frames.contains(&pixels), "each frame is another");
            frames.push(pixels);
        }
        // Titles and the point differ, the axes and the bar do not: their pixels are the same.
        let inked =
            |pixels: &[u8], row: usize| pixels[3 * row * width..3 * (row + 1) * width].to_vec();
        assert_eq!(
            inked(&frames[0], height - 12),
            inked(&frames[2], height - 12)
        );
    }

    #[test]
    fn films_that_cannot_be_are_refused() {
        let folder = Folder::new("film-refused");
        let error = Film::new(folder.file("a.png")).finish().unwrap_err();
        assert!(
            error.to_string().contains("a film of 0 frames at 25"),
            "{error}"
        );
        let mut film = Film::new(folder.file("a.png")).rate(0);
        film.frame(0.0, picture(0.5)).unwrap();
        let larger = Picture::new(121, 80).bounds([0.0; 2], [1.2, 0.8]);
        let error = film.frame(0.1, larger).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("give all pictures of a film the size"),
            "{error}"
        );
        let error = film.finish().unwrap_err();
        assert!(
            error.to_string().contains("1 frames at 0 frames a second"),
            "{error}"
        );
    }
}
