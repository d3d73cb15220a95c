//! Letters as pixels, for pictures that have no fonts at hand: five columns and seven rows, two more below the line.
//! Each row is a digit of base 32, whose bits are its pixels from the left.

/// Columns from a letter to the next.
pub(super) const ADVANCE: usize = 6;
/// Rows of a letter above the line that it stands on.
pub(super) const HEIGHT: usize = 7;

const LETTERS: [(char, &str); 92] = [
    ('0', "EHJLPHE"),
    ('1', "4C4444E"),
    ('2', "EH1248V"),
    ('3', "V2421HE"),
    ('4', "26AIV22"),
    ('5', "VGU11HE"),
    ('6', "68GUHHE"),
    ('7', "V124888"),
    ('8', "EHHEHHE"),
    ('9', "EHHF12C"),
    ('A', "EHHVHHH"),
    ('B', "UHHUHHU"),
    ('C', "EHGGGHE"),
    ('D', "UHHHHHU"),
    ('E', "VGGUGGV"),
    ('F', "VGGUGGG"),
    ('G', "EHGNHHF"),
    ('H', "HHHVHHH"),
    ('I', "E44444E"),
    ('J', "72222IC"),
    ('K', "HIKOKIH"),
    ('L', "GGGGGGV"),
    ('M', "HRLLHHH"),
    ('N', "HHPLJHH"),
    ('O', "EHHHHHE"),
    ('P', "UHHUGGG"),
    ('Q', "EHHHLID"),
    ('R', "UHHUKIH"),
    ('S', "FGGE11U"),
    ('T', "V444444"),
    ('U', "HHHHHHE"),
    ('V', "HHHHHA4"),
    ('W', "HHHLLLA"),
    ('X', "HHA4AHH"),
    ('Y', "HHHA444"),
    ('Z', "V1248GV"),
    ('a', "00E1FHF"),
    ('b', "GGMPHHU"),
    ('c', "00EGGHE"),
    ('d', "11DJHHF"),
    ('e', "00EHVGE"),
    ('f', "698S888"),
    ('g', "00FHHHF1E"),
    ('h', "GGMPHHH"),
    ('i', "40C444E"),
    ('j', "2062222IC"),
    ('k', "GGIKOKI"),
    ('l', "C44444E"),
    ('m', "00QLLHH"),
    ('n', "00MPHHH"),
    ('o', "00EHHHE"),
    ('p', "00UHHHUGG"),
    ('q', "00FHHHF11"),
    ('r', "00MPGGG"),
    ('s', "00FGE1U"),
    ('t', "88S8896"),
    ('u', "00HHHJD"),
    ('v', "00HHHA4"),
    ('w', "00HHLLA"),
    ('x', "00HA4AH"),
    ('y', "00HHHHF1E"),
    ('z', "00V248V"),
    ('.', "00000CC"),
    (',', "00000CC48"),
    (':', "0CC0CC0"),
    (';', "0CC0CC48"),
    ('-', "000V000"),
    ('−', "000V000"),
    ('+', "044V440"),
    ('/', "01248G0"),
    ('(', "2488842"),
    (')', "8422248"),
    ('[', "E88888E"),
    (']', "E22222E"),
    ('=', "00V0V00"),
    ('%', "OP248J3"),
    ('_', "000000V"),
    ('*', "04LEL40"),
    ('×', "00HA4AH"),
    ('<', "248G842"),
    ('>', "8421248"),
    ('\'', "C480000"),
    ('"', "AAA0000"),
    ('!', "4444404"),
    ('?', "EH12404"),
    ('|', "4444444"),
    ('&', "CIK8LID"),
    ('#', "AAVAVAA"),
    ('°', "CIIC000"),
    ('µ', "00HHHPMGG"),
    ('·', "000CC00"),
    (' ', ""),
];

/// A letter that the font lacks.
const UNKNOWN: &str = "VHHHHHV";

/// The pixels of a letter that are inked, as column and row.
pub(super) fn pixels(letter: char) -> impl Iterator<Item = (usize, usize)> {
    let known = LETTERS.iter().find(|own| own.0 == letter);
    let rows = known.map_or(UNKNOWN, |own| own.1);
    rows.chars().enumerate().flat_map(|(row, digit)| {
        let bits = digit.to_digit(32).unwrap_or(0);
        let inked = move |column: &usize| bits >> (4 - column) & 1 == 1;
        (0..5).filter(inked).map(move |column| (column, row))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_is_drawn_and_none_as_another() {
        for (k, (letter, rows)) in LETTERS.iter().enumerate() {
            assert!(*letter == ' ' || (7..=9).contains(&rows.len()), "{letter}");
            assert!(rows.chars().all(|digit| digit.is_digit(32)), "{letter}");
            for (other, others) in &LETTERS[..k] {
                let alike = [['-', '−'], ['x', '×']].contains(&[*other, *letter]);
                assert!(
                    letter != other && (alike || rows != others),
                    "{letter} and {other}"
                );
            }
        }
        // An L is a column and a row.
        assert_eq!(pixels('L').count(), 7 + 4);
        assert_eq!(pixels('あ').count(), pixels('□').count());
        assert_eq!(pixels(' ').count(), 0);
    }
}
