//! Real bodies: moments of inertia in units of C about the principal axes, each with its source.
//!
//! "Homogeneous" moments follow from a shape's semi-axes a ≥ b ≥ c as A : B : C = b² + c² : a² + c² : a² + b².
//! A source said to be recalled is quoted from memory and was not seen when the figure was entered; any other is attributed to it, and was not held against it either.

pub(crate) struct Entry {
    pub(crate) name: &'static str,
    pub(crate) moments: [f64; 3],
    pub(crate) source: &'static str,
}

const ENTRIES: &[Entry] = &[
    Entry {
        name: "Earth",
        moments: [0.996_715_23, 0.996_737_18, 1.0],
        source: "H = 3.273795e-3, C22 = 1.5744e-6, S22 = -0.9038e-6 (recalled; IERS Conventions 2010)",
    },
    Entry {
        name: "Mars",
        moments: [0.994_284_49, 0.994_976_76, 1.0],
        source: "J2 = 1.9566e-3, C/MR^2 = 0.3644 (recalled; Konopliv 2020)",
    },
    Entry {
        name: "Ceres",
        moments: [0.925_536_53, 0.930_145_38, 1.0],
        source: "semi-axes 482.79, 480.57, 445.57 km, homogeneous (Park 2016)",
    },
    Entry {
        name: "Vesta",
        moments: [0.798_544_23, 0.825_800_63, 1.0],
        source: "semi-axes 286.3, 278.6, 223.2 km, homogeneous (Russell 2012)",
    },
    Entry {
        name: "Eros",
        moments: [0.229_426_77, 0.963_753_52, 1.0],
        source: "A, B, C = 17.09, 71.79, 74.49 km^2 (recalled; Miller 2002)",
    },
    Entry {
        name: "Itokawa",
        moments: [0.349_156_47, 0.885_271_06, 1.0],
        source: "axes 535, 294, 209 m, homogeneous (Demura 2006)",
    },
    Entry {
        name: "Bennu",
        moments: [0.906_847_56, 0.933_216_78, 1.0],
        source: "semi-axes 252.78, 246.20, 228.69 m, homogeneous (Scheeres 2020)",
    },
    Entry {
        name: "Apophis",
        moments: [0.61, 0.965, 1.0],
        source: "A/C, B/C of the tumbling solution (Pravec 2014, Icarus 233, 48)",
    },
    Entry {
        name: "Toutatis",
        moments: [1.0 / 3.22, 3.09 / 3.22, 1.0],
        source: "A : B : C = 1 : 3.09 : 3.22 (recalled; Hudson & Ostro 1995); a long-axis rotator: closed form, the series do not serve it",
    },
    Entry {
        name: "Moon",
        moments: [0.999_369_25, 0.999_596_95, 1.0],
        source: "(C-A)/B = 6.310e-4, (B-A)/C = 2.277e-4 (recalled; Williams 2014); synchronous: a spin resonance under its own orbit, which no averaging serves",
    },
    Entry {
        name: "Dimorphos",
        moments: [0.709_878_4, 0.726_970_3, 1.0],
        source: "axes 177, 174, 116 m, homogeneous (recalled; Daly 2023); synchronous: a spin resonance under its own orbit, which no averaging serves",
    },
];

pub(crate) fn find(name: &str) -> Option<&'static Entry> {
    ENTRIES.iter().find(|entry| entry.name.eq_ignore_ascii_case(name))
}

pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    ENTRIES.iter().map(|entry| entry.name)
}
