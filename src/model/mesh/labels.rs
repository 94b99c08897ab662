//! Numbers that a file gives to nodes and elements: what people know them by.

/// Numbers of nodes and elements, by place; of a generated mesh there are none, and places are numbers.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Labels {
    pub nodes: Numbers,
    pub elements: Numbers,
    /// SHA-256 of the mesh as it is taken (nodes, elements, sets), hexadecimal: whether two runs had the same.
    pub hash: String,
}

/// Numbers by place; parts that count from one again have names.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Numbers {
    pub of: Vec<u64>,
    /// First place of a part, and its name; ascending.
    pub parts: Vec<(u32, String)>,
}

impl Numbers {
    /// `17`, or `TREAD-1.17` of a part.
    pub fn text(&self, place: usize) -> String {
        let Some(number) = self.of.get(place) else { return place.to_string() };
        let part = self.parts.partition_point(|p| p.0 as usize <= place).checked_sub(1);
        match part.map(|p| self.parts[p].1.as_str()) {
            Some(name) if !name.is_empty() => format!("{name}.{number}"),
            _ => number.to_string(),
        }
    }

    /// The first few of `places`, and how many there are more.
    pub fn list(&self, places: &[u32]) -> String {
        const SHOWN: usize = 5;
        let first: Vec<String> = places.iter().take(SHOWN).map(|&p| self.text(p as usize)).collect();
        let more = places.len().saturating_sub(SHOWN);
        let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("{}{rest}", first.join(", "))
    }

    /// With the places `kept` only, ascending.
    pub fn only(&self, kept: &[u32]) -> Numbers {
        let of = kept.iter().map(|&p| self.of[p as usize]).collect();
        let parts = self
            .parts
            .iter()
            .map(|(first, name)| (kept.partition_point(|&p| p < *first) as u32, name.clone()));
        Numbers { of, parts: parts.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_file() {
        let parts = vec![(0, String::new()), (2, "TREAD-1".into()), (4, "RIM".into())];
        let numbers = Numbers { of: vec![10, 20, 1, 2, 1], parts };
        assert_eq!([0, 1, 2, 3, 4].map(|p| numbers.text(p)), ["10", "20", "TREAD-1.1", "TREAD-1.2", "RIM.1"]);
        let kept = numbers.only(&[1, 3, 4]);
        assert_eq!([0, 1, 2].map(|p| kept.text(p)), ["20", "TREAD-1.2", "RIM.1"]);
        assert_eq!(kept.list(&[0, 1]), "20, TREAD-1.2");
        assert_eq!(Numbers::default().text(3), "3");
        assert_eq!(
            Numbers { of: (1..9).collect(), parts: vec![] }.list(&[0, 1, 2, 3, 4, 5, 6]),
            "1, 2, 3, 4, 5 and 2 more"
        );
    }
}
