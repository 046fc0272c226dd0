//! Language of all texts for readers: banned words, widths and plurals.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use hysteron::schema::TABLES;
use hysteron::spec::Spec;
use hysteron::stats::CAUTIONS;

use crate::bench::{Bench, SPEC, code, stdout};

/// Words and phrases outside plain technical English, with the replacement.
const BANNED: [(&str, &str); 50] = [
    ("nobody", "no task, none"),
    ("anew", "again"),
    ("greatest", "maximum, largest"),
    ("least", "minimum, smallest; \"at least\" is allowed"),
    ("beside", "with, next to"),
    ("taken off", "removed, subtracted"),
    ("at rest", "in equilibrium"),
    ("told", "reported, stated"),
    ("tells", "states, reports"),
    ("verb", "command"),
    ("verbs", "commands"),
    ("turning point", "load reversal"),
    ("turning points", "load reversals"),
    ("tabor number", "Tabor parameter"),
    ("pull-off load", "pull-off force"),
    ("audit gap", "energy-balance error"),
    ("conformity number", "U_el/Δγ of the shortest octave"),
    ("closer look", "single cycle"),
    ("slips", "errata, uncorrected equations"),
    ("so many", "a number"),
    ("some ten", "about 10"),
    ("some hundred", "about 100"),
    ("some hundreds", "a few hundred"),
    ("jump-off load", "pull-off force"),
    ("learns", "no personification"),
    ("learn of", "no personification"),
    ("knows", "no personification"),
    ("wants", "no personification"),
    ("newcomer", "new user"),
    ("preimage", "key inputs"),
    ("orphan", "unreferenced"),
    ("is no verb", "unknown command"),
    ("is no number", "is not a number"),
    ("allowed:", "help: action"),
    ("on its way", "checkpointed"),
    ("whole contact", "global problem"),
    ("asked for", "requested, target"),
    ("those that", "a noun"),
    ("of those", "a noun"),
    ("[1e-3]", "10⁻³"),
    ("stand", "are"),
    ("stands", "is; \"stands for\" is allowed"),
    ("tell", "state, report, distinguish"),
    ("asks", "requires, requests"),
    ("somebody", "a user, a program"),
    ("anybody", "a user, a program"),
    ("whoever", "a user, a program"),
    ("remembers", "stores, records"),
    ("forgets", "removes, discards"),
    ("believes", "no personification"),
];

/// Beginnings that a doc comment must not have: it begins with the name of the item.
const BEGINNINGS: [&str; 6] = ["what", "whether", "where", "how", "so", "the same"];

/// Exceptions: a phrase in which a banned word is right.
const RIGHT: [&str; 7] = [
    "at least",
    "stand for",
    "stands for",
    // The mathematical term.
    "least squares",
    "least squares:",
    "least-squares",
    // The status word of `status`, which is part of the contract.
    "is orphan",
];

/// Words after a number 1 that end in s and are no plurals.
const SINGULAR: [&str; 6] = ["is", "has", "as", "was", "gives", "plus"];

struct Text {
    place: String,
    content: String,
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Words in lower case with single spaces, framed by spaces; punctuation other than hyphens and colons is removed.
fn plain(line: &str) -> String {
    let kept: String = line.to_lowercase().chars().map(|c| if c.is_alphanumeric() || "-:[].'⁻³".contains(c) { c } else { ' ' }).collect();
    let words: Vec<&str> =
        kept.split_whitespace().map(|word| if word == "allowed:" { word } else { word.trim_end_matches(['.', ':']) }).collect();
    format!(" {} ", words.join(" "))
}

/// A banned phrase in a line, with its replacement.
fn banned(line: &str) -> Option<(&'static str, &'static str)> {
    let line = RIGHT.iter().fold(plain(line), |line, right| line.replace(&plain(right), " "));
    BANNED.iter().copied().find(|(phrase, _)| {
        let found = |end: &str| line.contains(&format!(" {phrase}{end}"));
        if phrase.ends_with([':', ']']) { found("") } else { found(" ") }
    })
}

/// A plural after the number 1, such as "1 units".
fn wrong_plural(line: &str) -> Option<String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    words.windows(2).find_map(|pair| {
        let [number, noun] = pair else { return None };
        let noun = noun.trim_matches(|c: char| !c.is_alphanumeric());
        let plural = noun.len() > 2 && noun.ends_with('s') && !noun.ends_with("ss") && noun.chars().all(|c| c.is_ascii_lowercase());
        (number.trim_start_matches('(') == "1" && plural && !SINGULAR.contains(&noun)).then(|| format!("1 {noun}"))
    })
}

/// All faults of texts; the width in characters, if there is a limit.
fn faults(texts: &[Text], width: Option<usize>) -> Vec<String> {
    let mut faults = Vec::new();
    for Text { place, content } in texts {
        for (number, line) in content.lines().enumerate().filter(|(_, line)| !line.is_empty()) {
            let mut add = |what: String| faults.push(format!("{place}:{}: {what}: {}", number + 1, line.trim()));
            if let Some((phrase, instead)) = banned(line) {
                add(format!("{phrase:?}, write {instead}"));
            }
            if let Some(plural) = wrong_plural(line) {
                add(format!("plural in {plural:?}"));
            }
            let length = line.chars().count();
            if width.is_some_and(|width| length > width) {
                add(format!("{length} columns"));
            }
        }
    }
    faults
}

#[track_caller]
fn check(texts: &[Text], width: Option<usize>) {
    assert!(!texts.is_empty() && texts.iter().all(|text| !text.content.trim().is_empty()), "no text");
    let faults = faults(texts, width);
    assert!(faults.is_empty(), "{} faults of style\n{}", faults.len(), faults.join("\n"));
}

/// Markdown without code: names of columns and commands may hold any word.
fn prose(markdown: &str) -> String {
    let mut fenced = false;
    let mut lines = Vec::new();
    for line in markdown.lines() {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        let code = fenced || fence || line.starts_with("    ");
        lines.push(if code { String::new() } else { line.split('`').step_by(2).collect::<Vec<_>>().join("X") });
    }
    lines.join("\n")
}

/// A paragraph of a comment.
struct Comment {
    /// Number of its first line, from 1.
    line: usize,
    /// True for the beginning of a doc comment.
    is_beginning: bool,
    /// The paragraph in one line, without code.
    text: String,
}

/// Paragraphs of the comments of a source file that begin a line, without code in backticks and fenced code.
fn comments(source: &str) -> Vec<Comment> {
    let mut all: Vec<Comment> = Vec::new();
    let (mut previous, mut fenced, mut continues) = ("", false, false);
    for (at, content) in source.lines().map(str::trim_start).enumerate() {
        let marker = ["///", "//!", "//"].into_iter().find(|marker| content.starts_with(*marker)).unwrap_or("");
        let is_first = marker != previous;
        previous = marker;
        (fenced, continues) = (fenced && !is_first, continues && !is_first);
        let text = content.strip_prefix(marker).unwrap_or_default().trim();
        let is_fence = text.starts_with("```");
        fenced ^= is_fence;
        if marker.is_empty() || text.is_empty() || fenced || is_fence {
            continues = false;
            continue;
        }
        match all.last_mut().filter(|_| continues && !text.starts_with(['-', '|', '#'])) {
            Some(comment) => comment.text.extend([" ", text]),
            None => all.push(Comment { line: at + 1, is_beginning: is_first && marker != "//", text: text.to_owned() }),
        }
        continues = !text.starts_with('#');
    }
    for comment in &mut all {
        comment.text = prose(&comment.text);
    }
    all
}

/// The forbidden beginning of a doc comment, if it has one.
fn wrong_beginning(comment: &Comment) -> Option<&'static str> {
    let text = plain(&comment.text);
    BEGINNINGS.into_iter().find(|words| comment.is_beginning && text.starts_with(&format!(" {words} ")))
}

/// All source files below a folder, without folders of build results.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let inside = |path: PathBuf| match path.is_dir() {
        true if path.ends_with("target") => Vec::new(),
        true => sources(&path),
        false => vec![path],
    };
    paths.into_iter().flat_map(inside).filter(|path| path.extension().is_some_and(|e| e == "rs")).collect()
}

/// HTML without figures, preformatted text, code and tags.
fn visible(html: &str) -> String {
    let mut text = html.to_owned();
    for tag in ["style", "svg", "pre", "code"] {
        let mut rest = text.as_str();
        let mut kept = String::new();
        while let Some((before, inside)) = rest.split_once(&format!("<{tag}")) {
            kept.push_str(before);
            rest = inside.split_once(&format!("</{tag}>")).map_or("", |(_, after)| after);
        }
        kept.push_str(rest);
        text = kept;
    }
    text.split('<').map(|piece| piece.split_once('>').map_or(piece, |(_, text)| text)).collect::<Vec<_>>().join(" ")
}

/// A file of the repository, as it is.
fn file(path: &Path) -> Text {
    Text { place: path.strip_prefix(root()).unwrap().display().to_string(), content: fs::read_to_string(path).unwrap() }
}

/// Checks Markdown files: width on all lines but those with a link or a table, language on prose.
fn check_markdown(paths: &[PathBuf]) {
    let texts: Vec<Text> = paths.iter().map(|path| file(path)).collect();
    let spoken: Vec<Text> = texts.iter().map(|text| Text { place: text.place.clone(), content: prose(&text.content) }).collect();
    check(&spoken, None);
    let long = |line: &&str| !line.contains("](") && !line.starts_with("<") && !line.starts_with('|');
    let narrow: Vec<Text> = texts
        .iter()
        .map(|text| Text {
            place: text.place.clone(),
            content: text.content.lines().map(|line| if long(&line) { line } else { "" }).collect::<Vec<_>>().join("\n"),
        })
        .collect();
    let wide: Vec<String> = faults(&narrow, Some(100)).into_iter().filter(|fault| fault.contains(" columns: ")).collect();
    assert!(wide.is_empty(), "{}", wide.join("\n"));
}

#[test]
fn law_style_of_the_readme_the_changelog_and_the_checklist() {
    check_markdown(&["README.md", "CHANGELOG.md", ".github/CONTRIBUTING.md"].map(|name| root().join(name)));
}

#[test]
fn law_style_of_the_guide() {
    let entries = fs::read_dir(root().join("src/guide")).unwrap().map(|entry| entry.unwrap().path());
    // The glossary translates older terms, which it therefore names.
    let mut pages: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|e| e == "md") && !path.ends_with("glossary.md")).collect();
    pages.sort();
    assert!(pages.len() > 10);
    check_markdown(&pages);
}

#[test]
fn law_style_of_comments() {
    let (mut texts, mut beginnings, mut count) = (Vec::new(), Vec::new(), 0);
    for path in sources(&root().join("src")) {
        let Text { place, content } = file(&path);
        // Each paragraph in the line of its beginning, for the numbers of lines in the message.
        let mut lines = vec![String::new(); content.lines().count()];
        for comment in comments(&content) {
            if let Some(words) = wrong_beginning(&comment) {
                beginnings.push(format!("{place}:{}: begins with {words:?}: {}", comment.line, comment.text));
            }
            count += 1;
            lines[comment.line - 1] = comment.text;
        }
        texts.push(Text { place, content: lines.join("\n") });
    }
    assert!(count > 4000, "{count} paragraphs");
    let mut found = faults(&texts, None);
    found.extend(beginnings);
    assert!(found.is_empty(), "{} faults of style in comments\n{}", found.len(), found.join("\n"));
}

#[test]
fn law_source_lines_have_at_most_110_columns() {
    let paths = sources(&root().join("src"));
    assert!(paths.len() > 300, "{} files", paths.len());
    let mut long = Vec::new();
    for path in paths {
        let Text { place, content } = file(&path);
        for (number, line) in content.lines().enumerate() {
            let columns = line.chars().count();
            if columns > 110 {
                long.push(format!("{place}:{}: {columns} columns", number + 1));
            }
        }
    }
    assert!(long.is_empty(), "{} long lines\n{}", long.len(), long.join("\n"));
}

#[test]
fn law_style_of_the_help() {
    let help = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_hysteron")).args(arguments).env("COLUMNS", "80").output().unwrap();
        assert_eq!(code(&output), 0, "{arguments:?}");
        Text { place: arguments.join(" "), content: stdout(&output) }
    };
    let first = help(&["--help"]);
    // Commands: indented names of lower-case letters, at the start of a line.
    let names = first.content.lines().filter(|line| line.starts_with("  ")).filter_map(|line| line.split_whitespace().next());
    let known = |name: &&str| {
        name.chars().all(|c| c.is_ascii_lowercase())
            && Command::new(env!("CARGO_BIN_EXE_hysteron")).args([name, "--help"]).output().is_ok_and(|output| code(&output) == 0)
    };
    let mut texts: Vec<Text> = names.filter(known).map(|name| help(&[name, "--help"])).collect();
    assert!(texts.len() >= 8, "{}", first.content);
    texts.push(first);
    check(&texts, Some(80));
}

#[test]
fn law_style_of_tables_and_warnings() {
    let mut texts = Vec::new();
    for table in TABLES {
        texts.push(Text { place: table.name.to_owned(), content: table.doc.to_owned() });
        for column in table.columns {
            texts.push(Text { place: format!("{}.{}", table.name, column.name), content: prose(column.doc) });
        }
    }
    for known in CAUTIONS {
        let content = [known.label, known.text, known.consequence, known.action].join("\n");
        texts.push(Text { place: known.code.to_owned(), content: prose(&content) });
    }
    check(&texts, None);
}

#[test]
fn law_style_of_spec_errors_and_example_specs() {
    let mut texts = Vec::new();
    for entry in fs::read_dir(root().join("tests/specs/bad")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if let Err(errors) = Spec::parse(&fs::read_to_string(&path).unwrap(), &name) {
            for fault in errors.faults() {
                let content = format!("{}\n{}", fault.message, fault.help.as_deref().unwrap_or(""));
                texts.push(Text { place: name.clone(), content: prose(&content) });
            }
        }
    }
    assert!(texts.len() > 80);
    for entry in fs::read_dir(root().join("pipelines")).unwrap() {
        texts.push(file(&entry.unwrap().path()));
    }
    check(&texts, None);
}

#[test]
fn law_style_of_the_report_and_of_the_results() {
    let bench = Bench::new(SPEC);
    let output = bench.verb("run", &[]);
    assert_eq!(code(&output), 0);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    let labels: String = page
        .split("<text")
        .skip(1)
        .filter_map(|piece| piece.split("</text>").next())
        .map(|text| format!("{}\n", visible(&format!("<text{text}"))))
        .collect();
    // The path of the program is that of the machine, and a command is not broken.
    let said = stdout(&output).replace(env!("CARGO_BIN_EXE_hysteron"), "hysteron");
    let texts = [("report.html", visible(&page)), ("figures", labels), ("stdout", prose(&said))];
    let texts = texts.map(|(place, content)| Text { place: place.to_owned(), content });
    check(&texts, None);
    // Results are at most 80 columns wide.
    check(&texts[2..], Some(80));
}

/// The checks find what they are for, and pass what is right.
#[test]
fn law_faults_of_style_are_found() {
    for bad in [
        "The greatest load",
        "of the Least two",
        "told by a verb.",
        "taken off the surface",
        "F_po [1e-3]",
        "; allowed: 1",
        "1 units",
        "found (1 tasks)",
    ] {
        let text = [Text { place: String::new(), content: bad.to_owned() }];
        let found = faults(&text, None);
        assert_eq!(found.len(), 1, "{bad}: {found:?}");
    }
    for good in [
        "at least two",
        "least-squares fit",
        "1 task, 20 tasks",
        "1 is the limit",
        "adverb",
        "`least_load_n` is a column",
        "0.1 units of length",
    ] {
        let text = [Text { place: String::new(), content: prose(good) }];
        assert_eq!(faults(&text, None), Vec::<String>::new(), "{good}");
    }
    assert_eq!(faults(&[Text { place: String::new(), content: "x".repeat(81) }], Some(80)).len(), 1);
    assert_eq!(visible("<p>a<svg><text>b</text></svg> c <code>d</code></p>").split_whitespace().collect::<Vec<_>>(), ["a", "c"]);
}

/// Paragraphs of comments are joined, with the number of their first line; code is omitted.
#[test]
fn law_comments_are_read() {
    let source = "//! Heights of those\n//! that remain.\n\n/// What it is.\n///\n/// What `is told`:\n/// - one\n/// - two\n\
                  fn f() {\n    // Where it stands.\n    let told = 1; // told\n}\n\
                  /// Code\n/// ```\n/// told\n/// ```\n/// # Errors\n/// Never.\n";
    let all = comments(source);
    let read: Vec<(usize, bool, &str)> = all.iter().map(|comment| (comment.line, comment.is_beginning, comment.text.as_str())).collect();
    let expected = [
        (1, true, "Heights of those that remain."),
        (4, true, "What it is."),
        (6, false, "What X:"),
        (7, false, "- one"),
        (8, false, "- two"),
        (10, false, "Where it stands."),
        (13, true, "Code"),
        (17, false, "# Errors"),
        (18, false, "Never."),
    ];
    assert_eq!(read, expected);
    let wrong = |comment: &Comment| wrong_beginning(comment).is_some() || banned(&comment.text).is_some();
    assert_eq!(all.iter().filter(|comment| wrong(comment)).map(|comment| comment.line).collect::<Vec<_>>(), [1, 4, 10]);
}
