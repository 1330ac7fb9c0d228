//! Codes and names of the frame of a kernel, and its text kernel.

use std::error::Error;
use std::fmt::{self, Display, Formatter, Write};

use crate::clock::{LAST, PIECES, TICKS};
use crate::daf::NAME;
use crate::frames;

/// Name of the frame if none is given, and its code.
const DEFAULT: (&str, i32) = ("ANDOYER_BODY", -999_000);
/// The clock of all frames.
const CLOCK: i32 = -999;
/// Characters of the name of a frame.
const LONGEST: usize = 26;
/// Smaller positive codes are those of planets, satellites and SPICE's own frames.
const LEAST: i32 = 1_000_000;

/// A name or a code that SPICE cannot use.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Refused {
    /// The argument.
    pub argument: &'static str,
    /// Its value.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
}

impl Display for Refused {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} must be {}: got {}", self.argument, self.allowed, self.value)
    }
}

impl Error for Refused {}

impl Refused {
    /// An error of an argument, with its value and what is allowed.
    pub fn new(argument: &'static str, value: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { argument, value: value.into(), allowed: allowed.into() }
    }
}

fn refused(argument: &'static str, value: impl fmt::Debug, allowed: impl Into<String>) -> Refused {
    Refused::new(argument, format!("{value:?}"), allowed)
}

/// Codes and names of a kernel, checked: those of the frame, of its centre, of its clock, of the segments.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    body_frame: String,
    frame: (i32, &'static str),
    code: i32,
    center: Option<i32>,
    clock: Option<i32>,
    users_clock: bool,
    segment: String,
}

impl Kernel {
    /// A kernel for the frame `body_frame` against the inertial frame `frame`.
    ///
    /// Its code is −999000 for the name ANDOYER_BODY. For any other name it is a number from −2,147,483,646 to −1,000,000,000 that is computed from the name,
    /// the same in every process.
    ///
    /// ```
    /// use andoyer_kernels::Kernel;
    /// assert_eq!(Kernel::new("ANDOYER_BODY", "J2000")?.code(), -999_000);
    /// assert_eq!(Kernel::new("TUMBLER", "J2000")?.code(), Kernel::new("TUMBLER", "ECLIPJ2000")?.code());
    /// let error = Kernel::new("J2000", "J2000").unwrap_err();
    /// assert!(error.to_string().starts_with("body_frame must be a name that SPICE has not taken"));
    /// # Ok::<(), andoyer_kernels::Refused>(())
    /// ```
    ///
    /// # Errors
    /// A `body_frame` that is not of 1 to 26 capital letters, digits and _, with a letter first, or that SPICE has taken ("J2000", "IAU_EARTH"). A `frame` that is no inertial
    /// frame of SPICE.
    pub fn new(body_frame: &str, frame: &str) -> Result<Self, Refused> {
        let plain = |letter: char| letter.is_ascii_uppercase() || letter.is_ascii_digit() || letter == '_';
        let first = body_frame.starts_with(|letter: char| letter.is_ascii_uppercase());
        if !first || body_frame.len() > LONGEST || !body_frame.chars().all(plain) {
            let allowed = format!("1 to {LONGEST} capital letters, digits and _, with a letter first");
            return Err(refused("body_frame", body_frame, allowed));
        }
        if frames::is_taken(body_frame) {
            return Err(refused("body_frame", body_frame, "a name that SPICE has not taken for a frame of its own"));
        }
        let Some(frame) = frames::find(frame) else {
            let allowed = "an inertial frame that SPICE knows, such as J2000, ECLIPJ2000 or ICRF";
            return Err(refused("frame", frame, allowed));
        };
        let segment = "ANDOYER".to_owned();
        Ok(Self {
            body_frame: body_frame.to_owned(),
            frame,
            code: Self::code_of(body_frame),
            center: None,
            clock: None,
            users_clock: false,
            segment,
        })
    }

    /// With this code of the frame: any negative one, or a positive one of an asteroid, a comet or a frame (1,000,000 or above).
    ///
    /// # Errors
    /// A code from 0 to 999,999, which has another meaning for SPICE.
    pub fn with_code(self, code: i32) -> Result<Self, Refused> {
        if (0..LEAST).contains(&code) {
            let allowed = format!(
                "negative or at least {LEAST} (asteroids and comets); SPICE uses the codes between for planets, satellites and its own frames"
            );
            return Err(refused("instrument", code, allowed));
        }
        Ok(Self { code, ..self })
    }

    /// With this name of the segments.
    ///
    /// # Errors
    /// A name that is blank, longer than 40 characters or not of printable ASCII.
    pub fn with_segment(self, segment: &str) -> Result<Self, Refused> {
        let plain = segment.chars().all(|letter| matches!(letter, ' '..='~'));
        if !plain || segment.trim().is_empty() || segment.len() > NAME {
            return Err(refused("segment", segment, format!("1 to {NAME} characters of printable ASCII")));
        }
        Ok(Self { segment: segment.to_owned(), ..self })
    }

    /// With the body that has this code as the centre of the frame. By default it is the body that the code of the frame names.
    #[must_use]
    pub fn with_center(self, center: Option<i32>) -> Self {
        Self { center, ..self }
    }

    /// With this code of the clock. `users`: the user has its kernel, and none is written; its code is then by default that of [`clock_of`](Self::clock_of).
    ///
    /// # Errors
    /// A code that is not negative.
    pub fn with_clock(self, clock: Option<i32>, users: bool) -> Result<Self, Refused> {
        if let Some(code) = clock.filter(|&code| code >= 0) {
            return Err(refused("clock_id", code, "negative"));
        }
        Ok(Self { clock, users_clock: users, ..self })
    }

    /// Code of the body's frame: its class ID.
    pub fn code(&self) -> i32 {
        self.code
    }

    /// Name of the body's frame.
    pub fn body_frame(&self) -> &str {
        &self.body_frame
    }

    /// Name of the inertial frame; the files have ICRF as J2000.
    pub fn frame(&self) -> &str {
        self.frame.1
    }

    /// Code of the inertial frame.
    pub fn frame_code(&self) -> i32 {
        self.frame.0
    }

    /// Name of the segments.
    pub fn segment(&self) -> &str {
        &self.segment
    }

    /// The code of a frame that has no other, computed from its name.
    pub fn code_of(body_frame: &str) -> i32 {
        if body_frame == DEFAULT.0 { DEFAULT.1 } else { derived(body_frame, 0) }
    }

    /// The spacecraft of a frame with a code from −999,999,999 to −1000: its thousands.
    fn spacecraft(code: i32) -> Option<i32> {
        (-999_999_999..=-1000).contains(&code).then_some(code / 1000)
    }

    /// Code of the clock of a frame, if none is given: −999; for a clock of the user the spacecraft that the code of the frame names, if it names one.
    pub fn clock_of(code: i32, users: bool) -> i32 {
        Self::spacecraft(code).filter(|_| users).unwrap_or(CLOCK)
    }

    /// Code of the clock: the given one, or that of [`clock_of`](Self::clock_of).
    pub fn clock(&self) -> i32 {
        self.clock.unwrap_or(Self::clock_of(self.code, self.users_clock))
    }

    /// Code of the centre: the given one; otherwise the spacecraft that the code of the frame names, or the code itself.
    pub fn center(&self) -> i32 {
        self.center.or(Self::spacecraft(self.code)).unwrap_or(self.code)
    }

    /// The text kernel beside a C-kernel: the frame and, if it is not the user's, the clock.
    pub fn text_of_ck(&self) -> String {
        let (code, clock) = (self.code, self.clock());
        let mut text = self.text(if self.users_clock { "FK" } else { "SCLK" }, code, 3);
        text += &format!("CK_{code}_SCLK = {clock}\nCK_{code}_SPK = {}\n", self.center());
        if !self.users_clock {
            text += &clock_text(clock.unsigned_abs());
        }
        text + "\n\\begintext\n"
    }

    /// The text kernel beside a binary PCK: the frame. Its own code is computed from its name too, so that a C-kernel for the same code is not disturbed.
    pub fn text_of_pck(&self) -> String {
        let frame = derived(&self.body_frame, 1);
        self.text("FK", frame, 2) + "\n\\begintext\n"
    }

    fn text(&self, kind: &str, frame: i32, class: i32) -> String {
        let Self { code, body_frame: name, .. } = self;
        format!(
            "KPL/{kind}\n\nWritten by andoyer {version} beside a binary kernel.\n\n\\begindata\n\nFRAME_{name} = {frame}\nFRAME_{frame}_NAME = '{name}'\n\
             FRAME_{frame}_CLASS = {class}\nFRAME_{frame}_CLASS_ID = {code}\nFRAME_{frame}_CENTER = {center}\n",
            version = env!("CARGO_PKG_VERSION"),
            center = self.center(),
        )
    }
}

/// The clock of [`crate::clock`] as a text kernel.
fn clock_text(number: u32) -> String {
    let mut text = format!("\nSCLK_KERNEL_ID = ( @2000-01-01 )\nSCLK_DATA_TYPE_{number} = ( 1 )\n");
    let variables = [
        ("TIME_SYSTEM", "1".to_owned()),
        ("N_FIELDS", "2".to_owned()),
        ("MODULI", format!("{LAST:.0} {TICKS:.0}")),
        ("OFFSETS", "0 0".to_owned()),
        ("OUTPUT_DELIM", "1".to_owned()),
        ("COEFFICIENTS", PIECES.map(|(tick, start, rate)| format!("\n   {tick:.0} {start:.0} {rate:.0}")).concat()),
    ];
    for (name, value) in variables {
        // Writing to a string does not fail.
        let _ = writeln!(text, "SCLK01_{name}_{number} = ( {value} )");
    }
    text + &format!("SCLK_PARTITION_START_{number} = ( 0.0 )\nSCLK_PARTITION_END_{number} = ( {:.0} )\n", LAST * TICKS)
}

/// A code from −2,147,483,646 to −1,000,000,000 from FNV-1a, 64 bits, of the name and a number. Among 1000 names two have the same one with a probability of 4e-4.
fn derived(name: &str, number: u8) -> i32 {
    let byte = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = byte(name.bytes().fold(0xcbf2_9ce4_8422_2325, byte), number);
    -1_000_000_000 - ((hash >> 16) % 1_147_483_647) as i32
}
