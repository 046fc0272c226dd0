//! The parts of a page of Markdown: code blocks, code spans, links, headings, columns of tables.

use std::path::{Path, PathBuf};

/// A block of code.
pub struct Block {
    pub language: String,
    pub code: String,
}

/// A page of the guide, or the README.
pub struct Page {
    pub name: String,
    pub path: PathBuf,
    pub blocks: Vec<Block>,
    /// Code in the text.
    pub spans: Vec<String>,
    /// Code in those columns of tables whose head says that it names columns.
    pub columns: Vec<String>,
    pub links: Vec<String>,
    pub headings: Vec<String>,
}

/// The README, the checklist of contributors and the pages of the guide.
pub fn pages() -> Vec<Page> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let guide = root.join("src/guide");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(&guide).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.extend(["README.md", ".github/CONTRIBUTING.md"].map(|name| root.join(name)));
    paths.sort();
    paths.iter().map(|path| Page::read(path)).collect()
}

impl Page {
    pub fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap().replace("\r\n", "\n");
        let (blocks, prose) = split(&text);
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let mut spans = Vec::new();
        for part in prose.split("\n\n") {
            assert!(part.matches('`').count().is_multiple_of(2), "{name}: a code span does not end in\n{part}");
            spans.extend(spans_of(part));
        }
        let links = prose.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link.to_owned()).collect();
        let headings = prose.lines().filter(|line| line.starts_with('#')).map(slug).collect();
        Self { columns: columns(&prose), name, path: path.to_owned(), blocks, spans, links, headings }
    }

    /// Whether it is a page of the guide.
    pub fn is_of_guide(&self) -> bool {
        self.path.parent().unwrap().ends_with("src/guide")
    }

    /// The blocks of a language.
    pub fn code<'a>(&'a self, language: &'a str) -> impl Iterator<Item = &'a str> {
        self.blocks.iter().filter(move |block| block.language == language).map(|block| block.code.as_str())
    }
}

/// The blocks of code, and the text without them.
fn split(text: &str) -> (Vec<Block>, String) {
    let (mut blocks, mut prose): (Vec<Block>, String) = (Vec::new(), String::new());
    let mut indent = None;
    for line in text.lines() {
        let trimmed = line.trim_start();
        match (indent, trimmed.strip_prefix("```")) {
            (None, Some(language)) => {
                indent = Some(line.len() - trimmed.len());
                blocks.push(Block { language: language.to_owned(), code: String::new() });
            }
            (None, None) => prose += &format!("{line}\n"),
            (Some(_), Some(_)) => indent = None,
            (Some(indent), None) => blocks.last_mut().unwrap().code += &format!("{}\n", line.get(indent..).unwrap_or_default()),
        }
    }
    assert!(indent.is_none(), "a fence does not end");
    (blocks, prose)
}

fn spans_of(text: &str) -> impl Iterator<Item = String> {
    text.split('`').skip(1).step_by(2).map(|span| span.replace('\n', " "))
}

/// The code in the columns of tables that name columns.
fn columns(prose: &str) -> Vec<String> {
    let cells = |line: &str| -> Vec<String> { line.trim_matches('|').split(" | ").map(str::to_owned).collect() };
    let mut found = Vec::new();
    let mut head: Option<Vec<String>> = None;
    for line in prose.lines() {
        match &head {
            _ if !line.starts_with('|') => head = None,
            None => head = Some(cells(line)),
            Some(head) => {
                let named = head.iter().zip(cells(line)).filter(|(head, _)| head.contains("column"));
                found.extend(named.flat_map(|(_, cell)| spans_of(&cell).collect::<Vec<_>>()));
            }
        }
    }
    found
}

/// The anchor of a heading, as repository pages and rustdoc make it.
fn slug(heading: &str) -> String {
    let kept = heading.trim_start_matches('#').trim().to_lowercase();
    kept.chars().filter(|c| c.is_alphanumeric() || "-_ ".contains(*c)).map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// The words of a command; quotes hold words together.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (place, part) in line.split(['"', '\'']).enumerate() {
        if place % 2 == 1 { words.push(part.to_owned()) } else { words.extend(part.split_whitespace().map(str::to_owned)) }
    }
    words
}

/// The calls of the program in a block for a shell.
pub fn commands(block: &str) -> Vec<Vec<String>> {
    let lines = block.replace("\\\n", " ");
    let lines = lines.lines().map(|line| line.split(" #").next().unwrap_or(line).trim()).filter(|line| !line.starts_with('#'));
    let call = |line: &str| {
        let words = words(line.split(['>', '|']).next().unwrap_or(line));
        match words.first().map(String::as_str) {
            Some("hysteron") => Some(words),
            Some("cargo") if words.get(1).is_some_and(|word| word == "run") => {
                let own = words.iter().skip_while(|word| *word != "--").skip(1).cloned();
                Some(std::iter::once("hysteron".to_owned()).chain(own).collect())
            }
            _ => None,
        }
    };
    lines.filter_map(call).collect()
}

/// A command that the text names, with values for its placeholders; nothing where the command itself is a placeholder.
pub fn command_of_text(span: &str) -> Option<Vec<String>> {
    let words = span.split_whitespace().filter(|word| !word.starts_with('[') && !word.ends_with(']') && !word.contains('…'));
    let words: Vec<String> = words
        .map(|word| match word {
            "N" => "1".to_owned(),
            "K/N" => "0/1".to_owned(),
            word => word.to_owned(),
        })
        .collect();
    words.get(1)?.starts_with(|c: char| c.is_ascii_lowercase() || c == '-').then_some(words)
}
