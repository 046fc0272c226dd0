"use strict";
(() => {
  const all = (of, query) => Array.from(of.querySelectorAll(query));
  const make = (name, text, attributes = {}) => {
    const element = document.createElement(name);
    element.textContent = text;
    for (const key in attributes) element.setAttribute(key, attributes[key]);
    return element;
  };
  const save = (name, text) => {
    const link = make("a", "", { download: name, href: URL.createObjectURL(new Blob([text], { type: "text/csv" })) });
    link.click();
    URL.revokeObjectURL(link.href);
  };

  // Tables: sort by a column, download as CSV.
  const value = (row, column) => {
    const text = row.cells[column].textContent.trim();
    const found = text.replace(/−/g, "-").match(/^-?[\d.]+(×10-?\d+)?/);
    return [found ? Number(found[0].replace("×10", "e")) : null, text];
  };
  const order = (column, sign) => (a, b) => {
    const [u, v] = [value(a, column), value(b, column)];
    if (u[0] === null || v[0] === null) return u[0] === v[0] ? sign * u[1].localeCompare(v[1]) : u[0] === null ? 1 : -1;
    return sign * (u[0] - v[0]);
  };
  const cell = (text) => (/[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text);
  for (const table of all(document, ".wide table")) {
    const heads = all(table, "thead th");
    const bodies = Array.from(table.tBodies);
    const rows = (body) => Array.from(body.rows).filter((row) => !row.classList.contains("group"));
    heads.forEach((head, column) => {
      // A button element is not printed in the heads that later pages repeat.
      const button = make("span", "", { role: "button", tabindex: "0", title: "Sort by this column" });
      button.append(...head.childNodes);
      head.append(button);
      const sort = () => {
        const up = head.getAttribute("aria-sort") !== "ascending";
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", up ? "ascending" : "descending");
        for (const body of bodies) body.append(...rows(body).sort(order(column, up ? 1 : -1)));
      };
      button.addEventListener("click", sort);
      button.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        sort();
      });
    });
    const tools = make("p", "", { class: "tools" });
    const csv = make("button", "Download CSV", { type: "button" });
    csv.addEventListener("click", () => {
      const texts = (cells) => Array.from(cells, (of) => of.textContent.replace(/\u00a0/g, " ").trim());
      const groups = bodies.some((body) => body.dataset.heading);
      const lines = [[...(groups ? ["sweep"] : []), ...texts(heads)]];
      for (const body of bodies) for (const row of rows(body)) lines.push([...(groups ? [body.dataset.heading] : []), ...texts(row.cells)]);
      const heading = table.closest(".wide").dataset.name;
      save(heading + ".csv", lines.map((line) => line.map(cell).join(",")).join("\n") + "\n");
    });
    tools.append(csv);
    table.closest(".wide").after(tools);
  }

  // Legends: a click hides or shows a case in all figures of its sweep.
  for (const legend of all(document, ".legend")) {
    for (const item of all(legend, "[data-colour]")) {
      const button = make("button", "", { type: "button", "aria-pressed": "true" });
      button.append(...item.childNodes);
      item.append(button);
      const colour = item.dataset.colour;
      button.addEventListener("click", () => {
        const show = button.getAttribute("aria-pressed") === "false";
        button.setAttribute("aria-pressed", String(show));
        for (const mark of all(legend.parentElement, `svg [stroke="${colour}"], svg [fill="${colour}"]`)) mark.style.display = show ? "" : "none";
      });
    }
  }

  // Figures: a click or Enter enlarges.
  for (const figure of all(document, ".panels > figure")) {
    const svg = figure.querySelector("svg");
    svg.setAttribute("tabindex", "0");
    const toggle = () => figure.classList.toggle("zoomed");
    svg.addEventListener("click", toggle);
    svg.addEventListener("keydown", (event) => event.key === "Enter" && toggle());
  }

  // On paper, details are open.
  const closed = () => all(document, "details:not([open])");
  let opened = [];
  addEventListener("beforeprint", () => (opened = closed()).forEach((of) => (of.open = true)));
  addEventListener("afterprint", () => opened.forEach((of) => (of.open = false)));

  // Text to copy.
  for (const block of all(document, "pre.copy")) {
    const tools = make("p", "", { class: "tools" });
    const button = make("button", "Copy", { type: "button" });
    button.addEventListener("click", () => {
      const range = document.createRange();
      range.selectNodeContents(block);
      getSelection().removeAllRanges();
      getSelection().addRange(range);
      document.execCommand("copy");
      button.textContent = "Copied";
    });
    tools.append(button);
    block.after(tools);
  }
})();
