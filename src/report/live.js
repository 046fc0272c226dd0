// The update of the page is compared with the clock. A clock that differs from that of the run is noticed by updates that still come.
const updated = Date.parse(document.getElementById("updated").dateTime);
const now = Date.now();
let seen = null;
try { seen = JSON.parse(sessionStorage.getItem("hysteron-updated")); } catch { /* no storage */ }
if (!seen || seen.updated !== updated) {
  seen = { updated, since: now, comes: seen !== null };
  try { sessionStorage.setItem("hysteron-updated", JSON.stringify(seen)); } catch { /* no storage */ }
}
const silent = now - seen.since > SILENT_MS || (!seen.comes && now - updated > SILENT_MS);
document.getElementById("ended").hidden = !silent;
document.getElementById("state").textContent = silent ? "interrupted" : "in progress";
document.title = document.title.replace("state of the run", silent ? "interrupted" : "in progress");
