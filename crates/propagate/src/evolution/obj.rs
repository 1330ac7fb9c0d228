//! Vertices and faces of a Wavefront OBJ file. Faces with more corners become fans of triangles; other lines are passed over.

use std::fs;
use std::path::Path;

use crate::error::Error;

/// The longest file \[bytes\].
const MOST_BYTES: u64 = 256 << 20;

/// A shape of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<[f64; 3]>,
    /// Three indices of vertices for each triangle, from 0.
    pub triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// The shape of an OBJ file, in its units and axes.
    ///
    /// # Errors
    /// - [`Error::SceneFile`] for a file that cannot be read or has more than 256 MiB, a line that has no three numbers or no three vertices, and a file without triangles.
    pub fn from_obj(path: impl AsRef<Path>) -> Result<Self, Error> {
        let name = path.as_ref().display().to_string();
        let failed = |key: &str, problem: String| refused(&name, key, problem);
        let bytes = fs::metadata(&path).map_err(|error| failed("file", error.to_string()))?.len();
        if bytes > MOST_BYTES {
            return Err(failed("file", format!("it has {bytes} bytes: it must have at most {MOST_BYTES}")));
        }
        let text = fs::read_to_string(&path).map_err(|error| failed("file", error.to_string()))?;
        Self::parse(&text).map_err(|(line, problem)| failed(&format!("line {line}"), problem))
    }

    /// The shape of a text, or a line, from 1, with its problem.
    fn parse(text: &str) -> Result<Self, (usize, String)> {
        let mut mesh = Self { vertices: Vec::new(), triangles: Vec::new() };
        for (number, line) in (1..).zip(text.lines()) {
            let mut words = line.split_whitespace();
            let read = match words.next() {
                Some("v") => mesh.add_vertex(words),
                Some("f") => mesh.add_face(words),
                _ => Ok(()),
            };
            read.map_err(|problem| (number, problem))?;
        }
        if mesh.triangles.is_empty() {
            return Err((text.lines().count(), "the file has no faces".to_owned()));
        }
        Ok(mesh)
    }

    fn add_vertex<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let numbers: Vec<f64> = words.take(3).map_while(|word| word.parse().ok()).collect();
        match numbers[..] {
            [x, y, z] if x.is_finite() && y.is_finite() && z.is_finite() => self.vertices.push([x, y, z]),
            _ => return Err("a vertex must have three finite numbers".to_owned()),
        }
        Ok(())
    }

    fn add_face<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let corner = |word: &str| -> Result<usize, String> {
            let index: i64 = word.split('/').next().and_then(|word| word.parse().ok()).unwrap_or(0);
            let count = self.vertices.len() as i64;
            // Negative indices count from the last vertex.
            let place = if index < 0 { count + index } else { index - 1 };
            let bound = || format!("{word} is no vertex: it must be from 1 to {count}, or from -1 down to -{count}");
            usize::try_from(place).ok().filter(|place| (*place as i64) < count).ok_or_else(bound)
        };
        let corners = words.map(corner).collect::<Result<Vec<_>, _>>()?;
        if corners.len() < 3 {
            return Err(format!("a face has {} corners: it must have three or more", corners.len()));
        }
        self.triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
        Ok(())
    }
}

fn refused(file: &str, key: &str, problem: String) -> Error {
    Error::SceneFile { file: file.to_owned(), key: key.to_owned(), problem, value: None, bound: None }
}
