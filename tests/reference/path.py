#!/usr/bin/env python3
"""Whole paths (loading, unloading) of a few coupled JKR asperities, made without the program.

Needs Python 3 with numpy, scipy and mpmath:  python path.py              all surfaces, writes the four tables (2 min)
                                              python path.py s1 p2        only these, writes nothing
Writes into this folder: path_surfaces.csv (the asperities), path_curves.csv (load, area, number of contacts on a grid
of approaches), path_states.csv (radius, displacement, load of each contact there), path_events.csv (every jump, in
order: approach, load after it, energy lost by its avalanche, what set the avalanche off).

The branch D_i - w_i = delta_JKR(a_i) is followed in double precision by pseudo-arclength continuation with a dense
Jacobian, straight through folds; every event is bracketed on the arc, then solved for (a, delta) together with its own
condition (p_k = delta_in, a_k = a_off, or det J = 0) in 60-digit arithmetic. The overdamped flow is integrated by
Radau IIA; the equilibrium it ends in is solved with 60 digits again. Energies, loads and areas come from the 60-digit
states; inputs are exact doubles. Notation: s = sqrt(2 pi g/E), p_i = D_i - w_i, J = d(delta_JKR + w)/da,
delta_JKR = a^2/R - s sqrt(a), F = 4 E a^3/(3R) - 2 E s a^(3/2).

Displacement w_i, periodic square of side L, self-balanced load, c_0 = F/(pi E), S_m = sum of 1/r^(2m+1) over all images
but the nearest (for j = i: but the spot itself), S_0 with its background:
    point:  sum over j != i of c_0j/r_ij (nearest image)          + sum over j of c_0j S_0(r_ij)
    spots:  sum over j != i of the exact field of the spot at r_ij + sum over j of sum_(m = 0..3) c_mj S_m(r_ij)
with c_m of the far field of a spot, w = sum c_m/r^(2m+1): from x 2F1(1/2, 1/2; 5/2; x^2) and asin x, x = a/r.
"""
import os, random, sys
from functools import lru_cache
from itertools import product

import numpy as np
from mpmath import mp, mpf
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

mp.dps = 60
OUT = os.path.dirname(os.path.abspath(__file__))
E, DG, EPS = 1e6, 0.07, 1e-9
# far field of a spot, m = 0..3, as fractions: of the Hertz part 1 + x^2/10 + ..., of asin x = x + x^3/6 + ...
FAR = [((1, 1), (1, 1)), ((1, 10), (1, 6)), ((9, 280), (3, 40)), ((5, 336), (5, 112))]
# id: kind, seed, n, L, box, R from, R to, height range, sep, turning approach (see surface())
SURFACES = {
    "s1": ("spots", 314, 5, 3e-4, 7.1e-5, 4e-5, 6e-5, 4e-7, 0.65, 4e-7),
    "s2": ("spots", 304, 9, 3e-4, 1.19e-4, 3e-5, 4.5e-5, 8e-7, 0.7, 2e-7),
    "s3": ("spots", 319, 8, 3e-4, 6.3e-5, 3e-5, 9e-5, 8e-7, 0.7, 2e-7),
    "s4": ("spots", 340, 8, 5e-4, 1.59e-4, 4e-5, 1.2e-4, 2e-7, 0.6, 2e-7),
    "s5": ("spots", 344, 7, 1e-3, 1.62e-4, 4e-5, 1.2e-4, 8e-7, 0.65, 4e-7),
    "s6": ("spots", 353, 10, 5e-4, 1.62e-4, 3e-5, 6e-5, 8e-7, 0.8, 6e-7),
    "s7": ("spots", 346, 6, 3e-4, 5e-5, 3e-5, 9e-5, 4e-7, 0.65, 6e-7),
    "s8": ("spots", 322, 3, 1e-3, 8.5e-5, 8e-5, 2e-4, 4e-7, 0.7, 2e-7),
    "s9": ("spots", 303, 7, 3e-4, 1.5e-4, 8e-5, 1.6e-4, 8e-7, 0.65, 6e-7),
    "p1": ("point", 435, 6, 5e-4, 1.3e-4, 4e-5, 1.2e-4, 4e-7, 0.8, 4e-7),
    "p2": ("point", 432, 8, 3e-4, 2.44e-4, 8e-5, 1.6e-4, 1e-7, 0.7, 4e-7),
    "p3": ("point", 433, 6, 5e-4, 4.9e-5, 2e-5, 4e-5, 2e-7, 0.8, 4e-7),
    "p4": ("point", 440, 10, 5e-4, 8.9e-5, 2e-5, 3e-5, 8e-7, 0.65, 4e-7),
    "p5": ("point", 417, 3, 1e-3, 4.2e-5, 3e-5, 9e-5, 8e-7, 0.6, 4e-7),
}


def surface(seed, n, L, box, r_lo, r_hi, z_range, sep):
    """Rows (x, y, z, R), short decimals, in a square of side box across the corner of the period;
    no two closer than sep (A_i + A_j), A = 2 (R^2 g/E)^(1/3)."""
    rng, rows = random.Random(seed), []
    A, near = lambda R: 2 * (R * R * DG / E) ** (1 / 3), lambda t: t - L * round(t / L)
    while len(rows) < n:
        x, y = (round(rng.uniform(L - box / 2, L + box / 2) % L, 8) for _ in range(2))
        R = round(rng.uniform(r_lo, r_hi), 7)
        if all(np.hypot(near(x - q[0]), near(y - q[1])) > sep * (A(R) + A(q[3])) for q in rows):
            rows.append((x, y, -round(rng.uniform(0, z_range), 9), R))
    top = max(q[2] for q in rows)
    return [(x, y, 0.0 if z == top else z, R) for x, y, z, R in rows]


def upper(z, first, last):
    """Incomplete gamma function Gamma(k + 1/2, z) for k = first..last, from erfc by recurrence."""
    g = {0: mp.sqrt(mp.pi) * mp.erfc(mp.sqrt(z))}
    for k in range(last):
        g[k + 1] = (k + mpf(1) / 2) * g[k] + z ** k * mp.sqrt(z) * mp.exp(-z)
    for k in range(-1, first - 1, -1):
        g[k] = (g[k + 1] - z ** k * mp.sqrt(z) * mp.exp(-z)) / (k + mpf(1) / 2)
    return g


@lru_cache(maxsize=None)
def reciprocal(k2, orders, alpha):
    """Weights in images() of the wavevectors q with |q|^2 = 4 pi^2 k2."""
    h = mp.pi ** 2 * k2
    g = upper(h / alpha ** 2, 1 - orders, 0)
    return [mp.pi / mp.gamma(m + mpf(1) / 2) * h ** (m - mpf(1) / 2) * g[-m] for m in range(orders)]


def images(x, y, orders, alpha=mpf(7) / 4):
    """Sums over all images but the nearest of 1/r^(2m+1), L = 1, m < orders; m = 0 less its background, so that with
    the nearest image its mean is 0. Ewald's split of 1/r^(2s), s = m + 1/2, by incomplete gamma functions."""
    r2, half, total = x * x + y * y, mpf(1) / 2, []
    for s in (m + half for m in range(orders)):
        near = mp.gammainc(s, 0, alpha ** 2 * r2) / mp.gamma(s) / r2 ** s if r2 else alpha ** (2 * s) / mp.gamma(s + 1)
        total.append(mp.pi / mp.gamma(s) * alpha ** (2 * s - 2) / (s - 1) - near)
    for i, j in product(range(-7, 8), repeat=2):
        if i or j:
            q2, wave = (x + i) ** 2 + (y + j) ** 2, mp.cos(2 * mp.pi * (i * x + j * y))
            g, h = upper(alpha ** 2 * q2, 0, orders - 1), reciprocal(i * i + j * j, orders, alpha)
            for m in range(orders):
                total[m] += g[m] / mp.gamma(m + half) / q2 ** (m + half) + h[m] * wave
    return total


def distances(rows, L, orders):
    """Nearest-image distances (L on the diagonal, never used) and S_m, m < orders, of all pairs."""
    n, L = len(rows), mpf(L)
    r, far, unit = np.full((n, n), L), np.full((orders, n, n), mpf(0)), [L ** (2 * m + 1) for m in range(orders)]
    own, own2 = (images(mpf(0), mpf(0), orders, alpha) for alpha in (mpf(7) / 4, mpf(2)))
    assert max(abs(p - q) for p, q in zip(own, own2)) < 1e-45                       # the split must not matter
    assert abs(own[0] + mpf("3.9002649200019558828454753366")) < 1e-27              # 4 zeta(1/2) beta(1/2)
    for i in range(n):
        far[:, i, i] = np.array(own) / unit
        for j in range(i):
            x, y = (mpf(rows[i][k]) - mpf(rows[j][k]) for k in (0, 1))
            x, y = x / L - mp.nint(x / L), y / L - mp.nint(y / L)
            r[i, j] = r[j, i] = L * mp.sqrt(x * x + y * y)
            far[:, i, j] = far[:, j, i] = np.array(images(x, y, orders)) / unit
    return r, far


class Model:
    """The equations; num = float: float64 arrays, num = mpf: arrays of 60-digit numbers. c: list of the contacts."""
    def __init__(self, rows, kind, r, far, num):
        vec = np.frompyfunc(num, 1, 1) if num is mpf else lambda v: np.array(v, dtype=float)
        ufunc = lambda f, g: np.frompyfunc(f, 1, 1) if num is mpf else g
        self.sqrt, self.asin = ufunc(mp.sqrt, np.sqrt), ufunc(mp.asin, np.arcsin)
        self.kind, self.n, self.off, third = kind, len(rows), 1 - np.eye(len(rows), dtype=int), mpf(1) / 3
        self.pi, self.E, self.g, self.s = (num(v) for v in (mp.pi, E, DG, mp.sqrt(2 * mp.pi * mpf(DG) / mpf(E))))
        self.r, self.far, self.z, R = vec(r), vec(far), vec([q[2] for q in rows]), [mpf(q[3]) for q in rows]
        self.series = [[num(mpf(p) / q) for p, q in pair] for pair in FAR[:len(far)]]
        unit = [(q * mpf(DG) ** 2 / mpf(E) ** 2) ** third for q in R]
        d_off = [-3 * mp.pi ** (2 * third) / 4 * u for u in unit]
        wu = [(1 - mpf("2.641") * (u / mpf(EPS)) ** (mpf(3) / 7)) * mpf(EPS) for u in unit]
        self.d_off, self.d_in = vec(d_off), vec([min(max(w, o), mpf(0)) for w, o in zip(wu, d_off)])
        self.R, self.a_off = vec(R), vec([(mp.pi * q * q * mpf(DG) / (8 * mpf(E))) ** third for q in R])
    def load(self, a, c):
        """F and dF/da."""
        h, t = self.E * a * a / self.R[c], self.E * self.s * self.sqrt(a)
        return 4 * h * a / 3 - 2 * t * a, 4 * h - 3 * t
    def w(self, a, c):
        """Displacement at all n centres by the contacts c, and its derivative to each a (n x len(c))."""
        r, off, R, q = self.r[:, c], self.off[:, c], self.R[c], self.sqrt(a)
        h, t = 4 * a * a / (3 * self.pi * R), 2 / self.pi * self.s * q
        C = [(a ** (2 * m + 1) * (h * H - t * P), a ** (2 * m) * ((2 * m + 3) * h * H - (2 * m + 1.5) * t * P))
             for m, (H, P) in enumerate(self.series)]                               # c_m, dc_m/da
        if self.kind == "point":
            X, dX = C[0][0] / r, C[0][1] / r
        else:
            if (r <= a).any():
                raise ArithmeticError("a centre is covered")
            u = r / a
            v = self.asin(1 / u)
            X = a * a / (self.pi * R) * (self.sqrt(u * u - 1) + (2 - u * u) * v) - t * v
            dX = 4 * a * v / (self.pi * R) - 2 / self.pi * self.s * (v / (2 * q) + q / self.sqrt(r * r - a * a))
        X, dX = off * X, off * dX
        for S, (C_m, dC_m) in zip(self.far, C):
            X, dX = X + S[:, c] * C_m, dX + S[:, c] * dC_m
        return X.sum(1), dX
    def residual(self, a, d, c):
        """g = D - w - delta_JKR on the contacts, J = -dg/da, and p = D - w on all."""
        if not c:
            return np.array([]), np.zeros((0, 0)), d + self.z
        w, dw = self.w(a, c)
        p, q = d + self.z - w, self.sqrt(a)
        return p[c] - (a * a / self.R[c] - self.s * q), dw[c] + np.diag(2 * a / self.R[c] - self.s / (2 * q)), p
    def jkr_radius(self, d, i):
        """Radius of asperity i at the penetration d, a >= a_off (double)."""
        a0, R = self.a_off[i], self.R[i]
        return brentq(lambda a: a * a / R - self.s * np.sqrt(a) - d, a0, 20 * a0 + 2 * np.sqrt(abs(d) * R))
    def totals(self, a, d, c):
        """Load, area and Pi = sum (U - g pi a^2) + 1/2 sum F w of the contacts. (60 digits)"""
        if not c:
            return mpf(0), mpf(0), mpf(0)
        w, F, R = self.w(a, c)[0][c], self.load(a, c)[0], self.R[c]
        p = d + self.z[c] - w
        U = self.E * (a * p * p - 2 * a ** 3 * p / (3 * R) + a ** 5 / (5 * R * R))
        return F.sum(), self.pi * (a * a).sum(), (U - self.g * self.pi * a * a + F * w / 2).sum()
    def solve(self, a, d, c, phi=None):
        """60 digits, Newton. Equilibrium a at the approach d; with phi, (a, d) where also phi(a, d) = 0 (its gradient
        by differences with a relative step of 1e-28)."""
        m, y = len(c), np.array([mpf(t) for t in a] + [mpf(d)], dtype=object)
        f = (lambda v: phi(v[:m], v[m])) if phi else lambda v: v[m] - mpf(d)
        for _ in range(40):
            g, J, _ = self.residual(y[:m], y[m], c)
            M, f0 = mp.matrix(m + 1, m + 1), f(y)
            for k in range(m + 1):
                e = np.array([mpf(10) ** -28 * (abs(y[k]) + mpf(10) ** -7) if q == k else mpf(0) for q in range(m + 1)])
                M[m, k] = (f(y + e) - f0) / e[k]
                for i in range(m):
                    M[i, k] = J[i, k] if k < m else -1
            step = np.array(list(mp.lu_solve(M, mp.matrix(list(g) + [-f0]))), dtype=object)
            y = y + step
            if max([abs(t / v) for t, v in zip(step[:m], y)] + [abs(step[m]) * 10 ** 6]) < mpf(10) ** -25:
                return y[:m], y[m]
        raise ArithmeticError("Newton")


class Path:
    def __init__(self, rows, L, kind, turn, step=0.02, rtol=1e-8, kick=1e-4, mobility=None):
        far = distances(rows, L, 1 if kind == "point" else len(FAR))
        self.X, self.D = Model(rows, kind, *far, mpf), Model(rows, kind, *far, float)
        self.turn, self.step, self.rtol, self.kick = turn, step, rtol, kick
        self.mobility = np.ones(len(rows)) if mobility is None else mobility
        self.events, self.points, self.folds, self.integral, self.cover = [], [], [], 0.0, 0.0
        self.barred, self.avalanches, self.ref = set(), 0, float(np.mean(-self.D.d_off))

    def relax(self, a, c, d):
        """Overdamped flow at fixed approach; the equilibrium it ends in and the spots that went, in order."""
        D, c, gone, horizon = self.D, list(c), [], 1e3
        while c:
            m, end = self.mobility[c], lambda t, u: (u / D.a_off[c]).min() - 1         # shrinks below a_off: removed
            end.terminal, end.direction = True, -1
            sol = solve_ivp(lambda t, u: m * D.residual(u, d, c)[0], (0, horizon), a, "Radau", events=end,
                            jac=lambda t, u: -m[:, None] * D.residual(u, d, c)[1],
                            rtol=self.rtol, atol=self.rtol * D.a_off[c].min())
            assert sol.status >= 0, sol.message
            a = sol.y[:, -1]
            if sol.status == 1:
                k = np.argmin(a / D.a_off[c])
                a = np.delete(a, k)
                gone.append(c.pop(k))
                continue
            g, J, _ = D.residual(a, d, c)
            if np.abs(np.linalg.solve(J, g) / a).max() < 1e-5 and np.linalg.eigvals(J).real.min() > 0:
                break
            horizon *= 10
            assert horizon < 1e12, "the flow does not settle"
        return a, c, gone

    def avalanche(self, kind, k, a, c, d, branch):
        """From the last equilibrium (a, c) at the exact approach d to the next one."""
        D, left, df, start, cc = self.D, set(), float(d), np.array(a, float), list(c)
        join, gone0, pi0 = (k if kind == "jump_in" else None), [], self.X.totals(a, d, c)[2]
        self.avalanches += 1
        if kind == "end":
            start, cc, gone0 = np.delete(start, c.index(k)), [i for i in c if i != k], [k]
        if kind == "fold":              # leave along the null vector, to the side the change of approach drives it
            self.folds.append(min(start / D.a_off[c]))
            U, _, Vt = np.linalg.svd(D.residual(start, df, c)[1])
            v = Vt[-1] * np.sign(self.way * U[:, -1].sum() * (U[:, -1] @ Vt[-1]))
            start = start + self.kick * v / np.abs(v / D.a_off[c]).max()
        while True:
            rows = []
            if join is not None:
                start, cc = np.append(start, D.jkr_radius(D.residual(start, df, cc)[2][join], join)), cc + [join]
                rows.append(("jump_in", join))
            a, cc, gone = self.relax(start, cc, df)
            rows += [("jump_off", i) for i in gone0 + gone] or ([("snap", -1)] if join is None else [])
            left, gone0 = left | set(gone0 + gone), []
            a = self.X.solve(a, d, cc)[0]
            F, _, pi1 = self.X.totals(a, d, cc)
            for q, (what, i) in enumerate(rows):        # the energy of a flow stands with its first change
                self.events.append((branch, len(self.events), what, i, d, F, pi0 - pi1 if q == 0 else mpf(0),
                                    self.avalanches, kind))
            pi0, start = pi1, np.array(a, float)
            over = (D.residual(start, df, cc)[2] - D.d_in) / -D.d_off
            self.barred = {i for i in left | self.barred if i not in cc and over[i] > -1e-9}
            due = [i for i in range(D.n) if i not in cc and i not in self.barred and over[i] >= 0]
            if not due:
                return a, cc
            join = max(due, key=lambda i: over[i])

    def on_arc(self, base, t, sigma, c):
        """Point of the branch on the plane t.(y - base) = sigma, y = (a/a_off, delta/ref); dy/dsigma; iterations."""
        y, sc = base + sigma * t, np.append(self.D.a_off[c], self.ref)
        for it in range(12):
            g, J, _ = self.D.residual(y[:-1] * sc[:-1], y[-1] * sc[-1], c)
            M = np.vstack([np.hstack([J * sc[:-1], np.full((len(c), 1), -sc[-1])]) / self.ref, t])
            step = np.linalg.solve(M, np.append(g / self.ref, sigma - t @ (y - base)))
            y = y + step
            if np.abs(step).max() < (1e-14 if it < 5 else 1e-12):
                return y, np.linalg.solve(M, np.append(np.zeros(len(c)), 1.0)), it
        raise ArithmeticError("corrector")

    def monitors(self, y, c, watch):
        """All positive while the branch goes on: det J, a/a_off - 1, delta_in - p of the free ones, way to the turn."""
        D, d = self.D, y[-1] * self.ref
        _, J, p = D.residual(y[:-1] * D.a_off[c], d, c)
        assert np.linalg.det(J) <= 0 or np.linalg.eigvals(J).real.min() > -1e-9, "unstable before det J = 0"
        return np.concatenate([[np.linalg.det(J)], y[:-1] - 1, (p[watch] - D.d_in[watch]) / D.d_off[watch],
                               [(self.turn - d) / self.ref if self.way > 0 else 1.0]]), p

    def branch(self, a, c, d, name):
        """Follow the equilibrium from (a, d) to the next event; returns (kind, asperity, a, d)."""
        D, X, sc, m = self.D, self.X, self.D.a_off[c], len(c)
        y, h = np.append(np.array(a, float) / sc, float(d) / self.ref), self.step / 8
        slope = np.linalg.solve(D.residual(y[:-1] * sc, float(d), c)[1], np.ones(m))
        t = np.append(slope * self.ref / sc, 1.0) * self.way
        t = t / np.linalg.norm(t)
        self.points.append((name, list(c), y[:-1] * sc, float(d)))
        while True:
            watch = [i for i in range(D.n) if i not in c and i not in self.barred]
            try:
                y1, dy, it = self.on_arc(y, t, h, c)
                if it > 5 or np.abs(y1 - y - h * t).max() > 0.2 * h or not (y1[:-1] > 0.5).all():
                    raise ArithmeticError("step too long")
                mon, p = self.monitors(y1, c, watch)
            except (ArithmeticError, np.linalg.LinAlgError):
                h /= 2
                assert h > 1e-9, "continuation stuck"
                continue
            hits = []
            for k in np.nonzero(mon <= 0)[0]:
                f = lambda s: self.monitors(self.on_arc(y, t, s, c)[0], c, watch)[0][k]
                hits.append((0.0 if f(0.0) <= 0 else brentq(f, 0, h, xtol=1e-15), k))
            end = min(hits)[0] if hits else h
            for x, weight in zip(*np.polynomial.legendre.leggauss(6)):         # work F d(delta), by Gauss on the arc
                ym, dm, _ = self.on_arc(y, t, end * (1 + x) / 2, c)
                self.integral += weight * end / 2 * D.load(ym[:-1] * sc, c)[0].sum() * dm[-1] * self.ref
            y1 = self.on_arc(y, t, end, c)[0] if hits else y1
            a1, d1 = y1[:-1] * sc, y1[-1] * self.ref
            self.points.append((name, list(c), a1, d1))
            self.cover = max(self.cover, (a1 / D.r[:, c] * D.off[:, c]).max())
            self.barred = {i for i in self.barred if p[i] >= D.d_in[i]}
            if not hits:
                y, t, h = y1, dy / np.linalg.norm(dy), min(self.step, 1.5 * h)
                continue
            k = min(hits)[1]
            kind, i = ([("fold", -1)] + [("end", q) for q in c] + [("jump_in", q) for q in watch] + [("turn", -1)])[k]
            phi = {"fold": lambda u, e: mp.det(mp.matrix(X.residual(u, e, c)[1].tolist())),
                   "end": lambda u, e: u[c.index(i)] / X.a_off[i] - 1,
                   "jump_in": lambda u, e: (X.residual(u, e, c)[2][i] - X.d_in[i]) / X.d_off[i],
                   "turn": lambda u, e: (e - mpf(self.turn)) / mpf(self.ref)}[kind]
            ax, dx = X.solve(a1, d1, c, phi)
            assert abs(dx - d1) < 1e-9 * self.ref and max(abs(ax / a1 - 1)) < 1e-6, (kind, float(dx - d1))
            return kind, i, ax, dx

    def run(self):
        k = min(range(self.D.n), key=lambda i: self.X.d_in[i] - self.X.z[i])
        d = self.X.d_in[k] - self.X.z[k]
        a, c = self.avalanche("jump_in", k, np.array([], dtype=object), [], d, "loading")
        for name, self.way in (("loading", 1), ("unloading", -1)):
            while c:
                kind, k, a, d = self.branch(a, c, d, name)
                if kind == "turn":
                    break
                a, c = self.avalanche(kind, k, a, c, d, name)
            assert c or name == "unloading", "all free again while loading"
        return self
    def state_at(self, d, name):
        """60-digit equilibrium at the approach d on a branch, from the nearest traced points."""
        on = [q for q in self.points if q[0] == name]
        for u, v in zip(on, on[1:]):
            if u[1] == v[1] and u[3] != v[3] and -1e-9 <= (d - u[3]) / (v[3] - u[3]) <= 1 + 1e-9:
                a, _ = self.X.solve(u[2] + (d - u[3]) / (v[3] - u[3]) * (v[2] - u[2]), d, u[1])
                assert max(abs(a / u[2] - 1)) < 0.1 and max(abs(a / v[2] - 1)) < 0.1
                return a, u[1]
    def grid(self, name, count=12):
        """Approaches of a branch, short decimals, at least 1.2 % of the range from its events."""
        ev = [float(e[4]) for e in self.events if e[0] == name]
        gap, out = 0.012 * (self.turn - min(ev)), [self.turn] if name == "loading" else []
        for k in range(count):
            base = min(ev) + (self.turn - min(ev)) * (k + 0.5) / count
            tries = (round(base + q * s * gap, 11) for q in range(40) for s in (1, -1))
            out.append(next(t for t in tries if min(ev) < t < self.turn and all(abs(t - e) > gap for e in ev + out)))
        return sorted(out, reverse=name == "unloading")


def tables(names, **settings):
    """The four tables as lists of rows of text; a summary of each surface is printed."""
    out = {"surfaces": ["surface,kind,L,n,asperity,x,y,z,R,delta_turn"],
           "curves": ["surface,branch,delta,F,A,contacts"], "states": ["surface,branch,delta,asperity,a,w,F"],
           "events": ["surface,branch,order,kind,asperity,delta,load_after,energy,avalanche,trigger"]}
    text = lambda t: mp.nstr(t, 17, min_fixed=1, max_fixed=0) if isinstance(t, mpf) else str(t)
    put = lambda table, *row: out[table].append(",".join(text(t) for t in row))
    for name in names:
        kind, seed, n, L, box, *rest, turn = SURFACES[name]
        rows, flows = surface(seed, n, L, box, *rest), {}
        P = Path(rows, L, kind, turn, **{k: v(n) if callable(v) else v for k, v in settings.items()}).run()
        for i, row in enumerate(rows):
            put("surfaces", name, kind, L, n, i, *row, turn)
        for branch, d in [(b, d) for b in ("loading", "unloading") for d in P.grid(b)]:
            a, c = P.state_at(d, branch)
            F, A, _ = P.X.totals(a, mpf(d), c)
            put("curves", name, branch, d, F, A, len(c))
            w, load = P.X.w(a, c)[0], P.X.load(a, c)[0]
            for k in np.argsort(c):
                put("states", name, branch, d, c[k], a[k], w[c[k]], load[k])
        for e in P.events:
            put("events", name, *e)
            flows.setdefault(e[7], []).append({"jump_in": "+", "jump_off": "-", "snap": "!"}[e[2]] + str(e[3]))
        print("%s %s n=%d | %s | least a/a_off at folds: %s | greatest a_j/r %.3f"
              % (name, kind, n, " ".join("".join(v) for v in flows.values()), ["%.4f" % q for q in P.folds], P.cover))
        W, loss = P.integral, float(sum(e[6] for e in P.events))
        print("   loop integral %.15e, energies %.15e, ratio - 1 = %.1e" % (W, loss, W / loss - 1), flush=True)
        assert P.cover < 1 and (kind == "spots" or abs(W / loss - 1) < 1e-10)
    return out


if __name__ == "__main__":
    for table, lines in tables(sys.argv[1:] or SURFACES).items():
        if len(sys.argv) == 1:
            with open(os.path.join(OUT, "path_%s.csv" % table), "w", newline="\n") as f:
                f.write("\n".join(lines) + "\n")
