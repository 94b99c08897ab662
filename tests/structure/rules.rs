//! What `structure` allows beside the rule, each with its reason. The lists should shrink.

/// Most files of one folder that may lead to one another.
pub const LARGEST_CIRCLE: usize = 3;

/// Imports between folders that do not count.
pub const FOLDERS: [(&str, &str, &str); 0] = [];

/// Files of later folders that unit tests of earlier ones may use.
pub const RIGS: [(&str, &str); 0] = [];

/// Where circles of files may be larger, or cross folders: the beginning of all their paths.
pub const CIRCLES: [(&str, &str); 1] =
    [("physics/", "a `Real` says which vectors hold it, and vectors are of a `Real`: scalar.rs and lanes/")];
