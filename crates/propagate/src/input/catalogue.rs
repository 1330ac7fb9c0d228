//! Real bodies: moments of inertia in units of C about the principal axes, each with its source.
//!
//! Every figure was read in the source that the entry names; "read in" names the copy that was read. A figure computed from these is called derived:
//! - homogeneous ellipsoid of semi-axes a ≥ b ≥ c: A : B : C = b² + c² : a² + c² : a² + b²;
//! - gravity field, with c = C/(M R²), J2 = −√5 C̄20 and J22 = √(5/12) |C̄22 + iS̄22|: A/C = 1 − (J2 + 2 J22)/c and B/C = 1 − (J2 − 2 J22)/c.
//!
//! A body is left out if one of its figures could not be read.

use crate::error::Error;

pub(crate) struct Entry {
    pub(crate) name: &'static str,
    pub(crate) moments: [f64; 3],
    pub(crate) source: &'static str,
}

const ENTRIES: &[Entry] = &[
    Entry {
        name: "Earth",
        moments: [0.996_715_22, 0.996_737_19, 1.0],
        source: "H = 3273795e-9 (read in pyshtools, dynamical_flattening_earth), C20 = -0.484165143790815e-3, C22 = 0.243938357328313e-5, S22 = -0.140027370385934e-5 (read: EGM2008, tide-free, normalized); A/C, B/C derived with C/MR^2 = J2/H",
    },
    Entry {
        name: "Ceres",
        moments: [0.930_413_46, 0.932_872_45, 1.0],
        source: "C20 = -0.1185104245101e-1, C22 = 0.2470083625411e-3, S22 = -0.2743996430843e-3 at 470 km (read: CERES18D, Konopliv 2018), mean moment 0.37 MR^2 (read: Park 2016, Nature 537, 515, abstract); C/MR^2 = 0.37 + 2/3 J2 and A/C, B/C derived: two digits of 1 - A/C hold",
    },
    Entry {
        name: "Vesta",
        moments: [0.817_733_35, 0.844_524_77, 1.0],
        source: "C20 = -0.3177939699038e-1, C22 = 0.4184962374624e-2, S22 = 0.1245378620599e-2 at 265 km (read: VESTA20H, Konopliv 2014, Icarus 240, 103), C/MR^2 = 0.4208 (read: Park 2025, Nat. Astron., s41550-025-02533-7, Extended Data Table 2); A/C, B/C derived",
    },
    Entry {
        name: "Eros",
        moments: [0.210_078_32, 0.983_109_82, 1.0],
        source: "C20 = -5.24618393097e-2, C22 = 8.23993879858e-2, S22 = -2.81095559016e-2 at 16 km (read: JGE15A01, file n15acoeff.tab of NEAR), C/M = 74.4434 km^2 (read: Izz of Miller's shape model, label navshcoeff.lbl); derived: 15.639, 73.186, 74.443 km^2",
    },
    Entry {
        name: "Itokawa",
        moments: [0.281_208_07, 0.951_422_75, 1.0],
        source: "derived for the Hayabusa shape model of 25,350 vertices with constant density (read in basilisk, ItokawaHayabusa.obj): 0.00631766, 0.02137479, 0.02246613 km^2",
    },
    Entry {
        name: "Didymos",
        moments: [0.770_877_89, 0.770_877_89, 1.0],
        source: "radii 394 +- 11 m and 290 +- 16 m of an oblate shape (read: Naidu 2024, abstract); derived for constant density",
    },
    Entry {
        name: "Apophis",
        moments: [0.61, 0.965, 1.0],
        source: "A/C = 0.61, B/C = 0.965 (Pravec 2014, Icarus 233, 48; published values, of which the paper's abstract alone was read); a short-axis tumbler, periods 27.38 h and 263 h in the extremal-axis convention (read in DAMIT)",
    },
    Entry {
        name: "Toutatis",
        moments: [1.0 / 3.235, 3.0836 / 3.235, 1.0],
        source: "A : B : C = 1 : 3.0836 : 3.235 (Takahashi 2013, read in Principia, euler_solver_test.cpp); a long-axis tumbler, periods 7.40 d and 5.38 d (read: Zhao 2015, arXiv:1504.02024)",
    },
    Entry {
        name: "Moon",
        moments: [0.999_369_23, 0.999_596_96, 1.0],
        source: "(C-A)/B = 631.0213e-6, (B-A)/C = 227.7317e-6 (Williams 2014, read in pyshtools); A/C, B/C derived; synchronous: a spin resonance under its own orbit, for which no averaged theory holds",
    },
    Entry {
        name: "Phobos",
        moments: [0.3615 / 0.5024, 0.4265 / 0.5024, 1.0],
        source: "A, B, C = 0.3615, 0.4265, 0.5024 MR^2 (read in a test of tudat); synchronous: a spin resonance under its own orbit, for which no averaged theory holds",
    },
    Entry {
        name: "Dimorphos",
        moments: [0.617_158_46, 0.873_664_03, 1.0],
        source: "after the impact of DART: a/b = 1.3, a/c = 1.6 (read: Naidu 2024, abstract); derived for constant density; near a spin resonance under its own orbit, for which no averaged theory holds",
    },
    Entry {
        name: "Hyperion",
        moments: [0.314 / 0.542, 0.474 / 0.542, 1.0],
        source: "A, B, C = 0.314, 0.474, 0.542 MR^2 (Harbison 2011, read at second hand); tumbles near a resonance of its nutation with its orbit",
    },
    Entry {
        name: "Envisat",
        moments: [0.131_442_23, 0.966_101_28, 1.0],
        source: "tensor 17023.3, 124825.7, 129112.2, Ixy 397.1, Ixz -2171.4, Iyz 344.2 kg m^2 by ESA (read: Sagnieres & Sharf 2019, doi 10.2514/1.G003647); principal moments derived: 16979.74, 124801.21, 129180.25 kg m^2",
    },
];

/// The entry with this name, in upper or lower case.
pub(crate) fn entry(name: &str) -> Result<&'static Entry, Error> {
    let unknown = || Error::UnknownBody { name: name.to_owned(), known: names().collect() };
    ENTRIES.iter().find(|entry| entry.name.eq_ignore_ascii_case(name)).ok_or_else(unknown)
}

pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    ENTRIES.iter().map(|entry| entry.name)
}
