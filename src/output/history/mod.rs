//! Histories at a high rate: `history_<name>.npz` and `history_<name>.uff`.
//!
//! The arrays of the `.npz` file, T times, P places, F faces:
//!
//! | array | type, shape | content |
//! |---|---|---|
//! | `time` | f8, T | times [s]: whole numbers of periods; stages that are not taken down leave gaps |
//! | `rate` | f8, one | values a second [Hz] |
//! | `filter` | f8, 3 | end of the pass band and beginning of the stop band over the rate, attenuation there [dB] |
//! | `turning` | bool, one | whether the places go with the material |
//! | `node` | u4, P | the mesh's node, from 0 (of points: the nearest corner) |
//! | `reference_position` | f8, P x 3 | in the reference shape [m] |
//! | `normal` | f8, P x 3 | unit, outwards; zero inside the body |
//! | `area` | f8, P | of the history's faces, by node [m2] |
//! | `face` | u4, F x 4 | places at the corners of outer faces, from 0, counter-clockwise seen from outside |
//! | `displacement`, `velocity`, `acceleration`, `position`, `contact_force` | f4, T x P x 3 | as the scene asks |
//! | `pressure` | f4, T x P | |
//! | `road_force` | f4, T x 3 | of the road on the whole body [N]; only with a road |

mod npy;
mod read;
mod uff;
mod zip;

pub use npy::write as write_npz;
pub use read::{Stored, read};
pub use uff::write as write_uff;
