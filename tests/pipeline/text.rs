//! Texts for people and for shells.

use hysteron::text::{counted, markdown, paragraph, printable, shell_quote, visible, with_one_unit};

#[test]
fn val_counts_have_their_plural() {
    assert_eq!([0, 1, 2].map(|count| counted(count, "task")), ["0 tasks", "1 task", "2 tasks"]);
}

#[test]
fn val_a_common_unit_follows_the_last_value() {
    assert_eq!(with_one_unit(&["0.01 J/m²", "0.02 J/m²"]), "0.01, 0.02 J/m²");
    assert_eq!(with_one_unit(&["1 mm", "2 µm"]), "1 mm, 2 µm");
    assert_eq!(with_one_unit(&["8", "16"]), "8, 16");
    assert_eq!(with_one_unit(&["1 MPa"]), "1 MPa");
}

#[test]
fn val_control_characters_are_written_out() {
    assert_eq!(visible("a\u{1b}[2J\n\t\u{9b}\u{202e}é"), "a\\u001b[2J\\n\\t\\u009b\\u202eé");
    assert_eq!(printable("a\n\tb\r\u{7}"), "a\n\tb\\r\\u0007");
    // What is JSON stays the same JSON.
    let text = serde_json::json!({ "name": "a\u{1b}\u{9b}\u{2028}" }).to_string();
    assert_eq!(serde_json::from_str::<serde_json::Value>(&printable(&text)).unwrap()["name"], "a\u{1b}\u{9b}\u{2028}");
}

#[test]
fn law_a_shell_reads_a_quoted_word_as_it_was() {
    assert_eq!(shell_quote("data/runs/H0.80_z8-x"), "data/runs/H0.80_z8-x", "what needs no quotes has none");
    let bash = |word: &str| {
        std::process::Command::new("bash").args(["-c", &format!("printf %s {}", shell_quote(word))]).env("LC_ALL", "C.UTF-8").output()
    };
    for word in [
        "",
        "sp ace",
        "it's",
        "$(touch x)",
        "`x`",
        "a;b",
        "~",
        "*",
        "!x",
        "\\",
        "a\\n",
        "é",
        "a\nb",
        "a\u{1b}'\\b",
        "\"",
        "-x",
        "a&b|c<d>e#f",
        "{a,b}",
    ] {
        let Ok(output) = bash(word) else {
            eprintln!("skipped: there is no bash");
            return;
        };
        assert_eq!(String::from_utf8_lossy(&output.stdout), word, "{}", shell_quote(word));
    }
}

#[test]
fn law_a_paragraph_keeps_its_words_within_100_columns() {
    let text = "Σθ of contact spots ".repeat(30);
    for marker in ["", "- ", "  - "] {
        let filled = paragraph(marker, &text);
        assert!(filled.lines().count() > 1 && filled.lines().all(|line| line.chars().count() <= 100), "{filled}");
        // No line is shorter than it has to be: the longest word has 7 characters.
        assert!(filled.lines().rev().skip(1).all(|line| line.chars().count() > 92), "{filled}");
        let indent = " ".repeat(marker.len());
        assert!(filled.starts_with(marker) && filled.lines().skip(1).all(|line| line.starts_with(&indent)), "{filled}");
        let words: Vec<&str> = filled.strip_prefix(marker).unwrap().split_whitespace().collect();
        assert_eq!(words, text.split_whitespace().collect::<Vec<_>>());
    }
}

#[test]
fn val_marks_of_markdown_are_escaped_outside_of_code() {
    assert_eq!(markdown("E* of <DIR> [default: `a*<b>`]"), "E\\* of \\<DIR\\> \\[default: `a*<b>`\\]");
}
