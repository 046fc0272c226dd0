//! The loop explorer of the report, driven in a browser without a window.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::bench::{Bench, SPEC, code, skip, stderr};
use hysteron::schema;
use hysteron::store::Frame;
use hysteron::store::parquet::read_table;

const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// The page after a script has run at its end; nothing without a browser.
fn after(page: &str, folder: &Path, script: &str) -> Option<String> {
    let browser = BROWSERS.into_iter().find(|name| Command::new(name).arg("--version").output().is_ok_and(|of| of.status.success()))?;
    let path = folder.join("driven.html");
    fs::write(&path, page.replace("</body>", &format!("<script>{script}</script></body>"))).unwrap();
    let mut command = Command::new(browser);
    command
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"])
        .arg(format!("--user-data-dir={}", folder.join("profile").display()));
    let output = command.arg(format!("file://{}", path.display())).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    Some(String::from_utf8(output.stdout).unwrap())
}

/// The text of an element without tags, by its identifier.
fn text(page: &str, id: &str) -> String {
    let rest = page.split(&format!("id=\"{id}\"")).nth(1).unwrap().split_once('>').unwrap().1;
    rest.split("</p>").next().unwrap().split("</figcaption>").next().unwrap().to_owned()
}

/// Values of an attribute in the element of an identifier, up to an end.
fn values(page: &str, id: &str, end: &str, name: &str) -> BTreeSet<i64> {
    let part = page.split(&format!("id=\"{id}\"")).nth(1).unwrap().split(end).next().unwrap();
    part.split(&format!("{name}=\"")).skip(1).map(|rest| rest.split('"').next().unwrap().parse().unwrap()).collect()
}

/// The first cycle of the explorer, and the first load.
struct Loop {
    steps: Frame,
    events: Frame,
    contacts: Frame,
    load: f64,
}

impl Loop {
    fn of(bench: &Bench, page: &str) -> Self {
        let data = page.split("id=\"explorer-data\"").nth(1).unwrap();
        let id = data.split("\"id\":\"").nth(1).unwrap().split('"').next().unwrap();
        let table = |of: &'static schema::Table| read_table(&bench.out().join("cycles").join(id).join(format!("{}.parquet", of.name)), of);
        let loop_of = |load| Self {
            steps: table(&schema::STEPS).unwrap(),
            events: table(&schema::EVENTS).unwrap(),
            contacts: table(&schema::CONTACTS).unwrap(),
            load,
        };
        loop_of(0.001)
    }

    /// Rows of the table `steps` along the loop.
    fn rows(&self) -> Vec<usize> {
        let (branches, of) = (self.steps.text("branch").unwrap(), self.steps.f64_or_null("max_load").unwrap());
        let up = || (0..branches.len()).filter(|row| branches[*row] == "loading");
        let reversal = self.steps.f64_or_null("reversal_load").unwrap().iter().position(|load| *load == Some(self.load)).unwrap();
        let down = (0..branches.len()).filter(|row| branches[*row] == "unloading" && of[*row] == Some(self.load));
        up().take_while(|row| *row <= reversal).chain(down).collect()
    }
}

/// A script that chooses the first cycle and load, and moves the slider to a place.
fn moved(place: usize) -> String {
    format!(
        "const set = (id, value, name) => {{ const of = document.getElementById(id); of.value = value; of.dispatchEvent(new Event(name)); }};\
         set('explorer-cycle', 0, 'change'); set('explorer-load', 0, 'change'); set('explorer-step', {place}, 'input');"
    )
}

/// Merged contacts have numbers that repeat between branches.
#[test]
fn e2e_spots_of_the_explorer_are_where_the_contacts_are() {
    let bench = Bench::new(&SPEC.replace("[cycle]", "[cycle]\ncontacts = \"all\"").replace("[6, 8]", "[16]"));
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    let data = page.split("id=\"explorer-data\"").nth(1).unwrap().split_once('>').unwrap().1.split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let cycle = &data["cycles"][0];
    let path = bench.out().join("cycles").join(cycle["id"].as_str().unwrap()).join("contacts.parquet");
    let contacts = read_table(&path, &schema::CONTACTS).unwrap();
    let (steps, states, ids) = (contacts.i64("step").unwrap(), contacts.text("state").unwrap(), contacts.i64("asperity_id").unwrap());
    let [x, y] = ["centroid_x_m", "centroid_y_m"].map(|name| contacts.f64(name).unwrap());
    let length = cycle["length_m"].as_f64().unwrap();
    let whole = |values: &serde_json::Value, at: usize| values[at].as_i64().unwrap();
    let summits = cycle["ids"].as_array().unwrap().len() - cycle["merged"].as_object().unwrap().len();
    let (mut compared, mut merged) = (0, 0);
    for turn in cycle["loops"].as_array().unwrap() {
        for (place, frame) in turn["frames"].as_object().unwrap() {
            let step = whole(&turn["s"], place.parse().unwrap());
            let rows: Vec<usize> = (0..steps.len()).filter(|row| steps[*row] == step && states[*row] == "contact").collect();
            assert_eq!(frame.as_array().unwrap().len(), 2 * rows.len());
            for (k, row) in rows.into_iter().enumerate() {
                let spot = whole(frame, 2 * k) as usize;
                assert_eq!(whole(&cycle["ids"], spot), ids[row], "step {step}");
                for (shown, centre) in [(&cycle["x"], x[row]), (&cycle["y"], y[row])] {
                    assert!((whole(shown, spot) as f64 - 1e4 * centre / length).abs() < 0.51, "step {step}, contact {}", ids[row]);
                }
                compared += 1;
                merged += usize::from(cycle["merged"].get(spot.to_string()).is_some());
            }
        }
    }
    assert!(compared > 100 && merged > 20 && summits > 20, "{compared} contacts, {merged} merged, {summits} asperities");
}

#[test]
fn e2e_the_slider_moves_the_contact_map() {
    let bench = Bench::new(SPEC);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    let of = Loop::of(&bench, &page);
    let rows = of.rows();
    let (numbers, counts) = (of.steps.i64("step").unwrap(), of.steps.i64("contact_count").unwrap());
    let branches = of.steps.text("branch").unwrap();
    // Steps along the loop, among them a stored one.
    let stored = of.contacts.i64("step").unwrap();
    let kept = rows.iter().position(|row| branches[*row] == "unloading" && stored.contains(&numbers[*row])).unwrap();
    for place in [0, rows.len() / 4, rows.len() / 2, kept, (kept + rows.len()) / 2, rows.len() - 1] {
        let Some(driven) = after(&page, bench.folder.path(), &moved(place)) else {
            skip("browser", "no Chromium or Chrome: the explorer is not driven");
            return;
        };
        let row = rows[place];
        assert!(text(&driven, "explorer-readout").starts_with(&format!("Step {}, {}:", numbers[row], branches[row])), "{place}");
        let shown = values(&driven, "explorer-spots", "</g>", "data-spot");
        assert_eq!(shown.len() as i64, counts[row], "contact spots at place {place} of {}", rows.len());
        if place == kept {
            let (ids, states) = (of.contacts.i64_or_null("asperity_id").unwrap(), of.contacts.text("state").unwrap());
            let of_step = |k: &usize| stored[*k] == numbers[row] && states[*k] == "contact";
            assert_eq!(shown, (0..stored.len()).filter(of_step).filter_map(|k| ids[k]).collect());
            assert!(text(&driven, "explorer-map-note").contains("Stored step"));
        }
    }
    avalanche(&bench, &page, &of);
}

/// Loads and penetrations of a probe have their units, as in its tables: a load reversal of 1 µN.
#[test]
fn e2e_the_explorer_of_a_probe_is_in_newtons() {
    let bench = Bench::new(
        "name = \"tip\"\nrealizations = 1\nsurface.length_m = 4e-5\nsurface.rms_height_m = 1e-9\nsurface.magnification = 4\n\
         surface.points_per_shortest_wavelength = 8\nprobe.radius_m = 2e-5\nmaterial.work_of_adhesion_j_m2 = 0.03\ncycle.max_force_n = [1e-6]\n",
    );
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    let Some(driven) = after(&page, bench.folder.path(), &moved(0)) else {
        skip("browser", "no Chromium or Chrome: the explorer is not driven");
        return;
    };
    let readout = text(&driven, "explorer-readout");
    assert!(readout.contains(": F = ") && readout.contains("N, Δ = ") && !readout.contains("E*"), "{readout}");
    let [chart, loads] = ["explorer-chart", "explorer-load"].map(|id| driven.split(&format!("id=\"{id}\"")).nth(1).unwrap());
    assert!(chart.contains("F [µN]") && chart.contains("Δ [nm]"), "{}", &chart[..2000]);
    assert!(loads.split("</select>").next().unwrap().contains("1 µN"));
}

/// A click shows the events of the next avalanche, and no others.
fn avalanche(bench: &Bench, page: &str, of: &Loop) {
    let script = format!("{} set('explorer-smallest', 1, 'change'); document.getElementById('explorer-next-avalanche').click();", moved(1));
    let driven = after(page, bench.folder.path(), &script).unwrap();
    let readout = text(&driven, "explorer-readout");
    let id: i64 = readout.split("avalanche ").nth(1).unwrap().split(':').next().unwrap().parse().unwrap();
    let (avalanches, spots) = (of.events.i64("avalanche_id").unwrap(), of.events.i64_or_null("asperity_id").unwrap());
    let branches = of.events.text("branch").unwrap();
    let own: BTreeSet<i64> =
        (0..avalanches.len()).filter(|k| avalanches[*k] == id && branches[*k] == "loading").filter_map(|k| spots[k]).collect();
    assert!(!own.is_empty());
    assert_eq!(values(&driven, "explorer-events", "</g>", "data-event"), own, "{readout}");
    // A case of the legend is hidden in all figures of its sweep by a click.
    let hide = "const item = document.querySelector('.legend [data-colour]'); item.querySelector('button').click(); \
                document.title = 'hidden ' + [...document.querySelectorAll(`svg [stroke=\"${item.dataset.colour}\"]`)].filter(of => of.style.display === 'none').length;";
    let driven = after(page, bench.folder.path(), hide).unwrap();
    let hidden: usize = driven.split("<title>hidden ").nth(1).unwrap().split('<').next().unwrap().parse().unwrap();
    assert!(hidden >= 4, "{hidden} curves are hidden");
    // A table is sorted by a click on the head of a column.
    let sort = "const button = document.querySelectorAll('[data-name=results] th [role=button]')[5]; button.click(); button.click(); \
                document.title = 'sorted ' + [...document.querySelectorAll('[data-name=results] tbody tr')].map(row => row.cells[5].textContent.split(' ')[0]).join(' ');";
    let driven = after(page, bench.folder.path(), sort).unwrap();
    let sorted: Vec<f64> =
        driven.split("<title>sorted ").nth(1).unwrap().split('<').next().unwrap().split(' ').map(|cell| cell.parse().unwrap()).collect();
    assert!(sorted.len() == 4 && sorted.windows(2).all(|pair| pair[0] >= pair[1]), "{sorted:?}");
}

#[test]
fn law_own_scripts_are_small() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/report");
    let size: usize = ["page.js", "explorer.js"].iter().map(|name| fs::read(folder.join(name)).unwrap().len()).sum();
    assert!(size <= 40_000, "{size} bytes");
}
