#include "generate/svg_path.h"

#include "base/exactmath.h"
#include "base/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 128 /* straight pieces of a curve: its box is off by at most 1/100000 of its size */

/* ---- parsing ---- */

static int count_of(char letter)
{
    switch (letter) {
    case 'M':
    case 'L':
    case 'T': return 2;
    case 'H':
    case 'V': return 1;
    case 'C': return 6;
    case 'S':
    case 'Q': return 4;
    case 'A': return 7;
    default: return 0;
    }
}

typedef struct Reader {
    const char *at;
    double x, y; /* present place */
    double start_x, start_y;
    WrSvgPiece last; /* for S and T */
} Reader;

static void skip(Reader *r)
{
    r->at += strspn(r->at, " \t\r\n,");
}

static size_t digits_of(const char *at)
{
    return strspn(at, "0123456789");
}

/* A number ends where another begins: "1.5.5-3" is three. flag: a single digit, 0 or 1. */
static bool read_number(Reader *r, bool flag, double *out)
{
    skip(r);
    const char *at = r->at;
    if (flag) {
        if (*at != '0' && *at != '1') return false;
        *out = *at - '0';
        r->at++;
        return true;
    }
    at += *at == '-' || *at == '+';
    size_t whole = digits_of(at), part = 0;
    at += whole;
    if (*at == '.') at += 1 + (part = digits_of(at + 1));
    if (whole + part == 0) return false;
    if (*at == 'e' || *at == 'E') {
        const char *power = at + 1;
        power += *power == '-' || *power == '+';
        if (digits_of(power) > 0) at = power + digits_of(power);
    }
    const char *from = r->at + (*r->at == '+');
    const bool good = wr_number_parse(from, (size_t)(at - from), out) && isfinite(*out);
    r->at = at;
    return good;
}

/* The mirror image of the last handle of a curve of that letter at the present place, else the place. */
static void reflect(const Reader *r, char letter, double out[2])
{
    const int k = letter == 'C' ? 2 : 0;
    const bool curve = r->last.letter == letter;
    out[0] = curve ? 2.0 * r->x - r->last.n[k] : r->x;
    out[1] = curve ? 2.0 * r->y - r->last.n[k + 1] : r->y;
}

/* Numbers of a command to a piece with absolute numbers. */
static WrSvgPiece piece_of(const Reader *r, char letter, bool relative, const double *n)
{
    WrSvgPiece p = { .letter = letter };
    const double dx = relative ? r->x : 0.0, dy = relative ? r->y : 0.0;
    const int count = count_of(letter);
    if (letter == 'H' || letter == 'V') {
        p.letter = 'L';
        p.n[0] = letter == 'H' ? n[0] + dx : r->x;
        p.n[1] = letter == 'V' ? n[0] + dy : r->y;
        return p;
    }
    const int from = letter == 'S' || letter == 'T' ? 2 : 0, kept = letter == 'A' ? 5 : 0;
    if (letter == 'S' || letter == 'T') p.letter = letter == 'S' ? 'C' : 'Q';
    if (from) reflect(r, p.letter, p.n);
    for (int k = 0; k < count; k++)
        p.n[from + k] = n[k] + (k < kept ? 0.0 : (k - kept) % 2 ? dy : dx);
    return p;
}

static int end_of(const WrSvgPiece *p)
{
    switch (p->letter) {
    case 'C': return 4;
    case 'Q': return 2;
    case 'A': return 5;
    default: return 0;
    }
}

static void add_piece(Reader *r, WrSvgPath *out, WrSvgPiece p)
{
    if (p.letter == 'Z') {
        r->x = r->start_x;
        r->y = r->start_y;
    } else {
        r->x = p.n[end_of(&p)];
        r->y = p.n[end_of(&p) + 1];
    }
    if (p.letter == 'M') {
        r->start_x = r->x;
        r->start_y = r->y;
    }
    r->last = p;
    wr_array_push(&out->pieces, p);
}

static bool read_all(Reader *r, WrSvgPath *out)
{
    for (skip(r); *r->at; skip(r)) {
        char letter = *r->at++;
        const bool relative = letter >= 'a';
        if (relative) letter = (char)(letter - 'a' + 'A');
        const int count = count_of(letter);
        if ((count == 0 && letter != 'Z') || (out->pieces.count == 0 && letter != 'M'))
            return false;
        if (letter == 'Z') add_piece(r, out, (WrSvgPiece){ .letter = 'Z' });
        for (bool first = true; letter != 'Z'; first = false) {
            double n[7];
            skip(r);
            if (!first && (!*r->at || strchr("MmZzLlHhVvCcSsQqTtAa", *r->at))) break;
            for (int k = 0; k < count; k++)
                if (!read_number(r, letter == 'A' && (k == 3 || k == 4), &n[k])) return false;
            add_piece(r, out, piece_of(r, letter == 'M' && !first ? 'L' : letter, relative, n));
        }
    }
    return out->pieces.count > 0;
}

bool wr_svg_path_parse(const char *text, WrSvgPath *out)
{
    Reader reader = { .at = text };
    *out = (WrSvgPath){ { 0 } };
    if (read_all(&reader, out)) return true;
    wr_svg_path_fini(out);
    return false;
}

void wr_svg_path_fini(WrSvgPath *path)
{
    wr_array_free(&path->pieces);
}

static double rounded(double x, int digits)
{
    double power = 1;
    for (int k = 0; k < digits; k++) power *= 10;
    return rint(x * power) / power + 0.0;
}

void wr_svg_path_print(const WrSvgPath *path, int digits, WrText *text)
{
    for (int i = 0; i < path->pieces.count; i++) {
        const WrSvgPiece *p = &path->pieces.data[i];
        wr_text_addf(text, "%s%c", i ? " " : "", p->letter);
        for (int k = 0; k < count_of(p->letter); k++) {
            if (k > 0) wr_text_add(text, p->letter == 'A' || k % 2 == 0 ? " " : ",");
            wr_text_add_number(text, rounded(p->n[k], digits));
        }
    }
}

/* ---- points ---- */

static void add_point(WrSvgPoint *points, int room, int *count, WrSvgPoint point)
{
    if (*count < room) points[*count] = point;
    ++*count;
}

int wr_svg_path_points(const WrSvgPath *path, WrSvgPoint *points, int room)
{
    int count = 0;
    double x = 0.0, y = 0.0; /* the end before */
    for (int i = 0; i < path->pieces.count; i++) {
        const WrSvgPiece *p = &path->pieces.data[i];
        const int end = end_of(p);
        if (p->letter == 'Z') continue;
        const double *to = p->n + end;
        if (p->letter == 'C')
            add_point(points, room, &count, (WrSvgPoint){ i, 0, true, p->n[0], p->n[1], { x, y } });
        if (p->letter == 'C' || p->letter == 'Q')
            add_point(
                points, room, &count,
                (WrSvgPoint){ i, end - 2, true, p->n[end - 2], p->n[end - 1], { to[0], to[1] } });
        add_point(points, room, &count, (WrSvgPoint){ i, end, false, to[0], to[1], { 0, 0 } });
        x = to[0];
        y = to[1];
    }
    return count;
}

void wr_svg_path_move(WrSvgPath *path, const WrSvgPoint *point, double x, double y)
{
    WrSvgPiece *p = &path->pieces.data[point->piece];
    const double dx = x - p->n[point->number], dy = y - p->n[point->number + 1];
    p->n[point->number] = x;
    p->n[point->number + 1] = y;
    if (point->handle) return;
    if (p->letter == 'C') {
        p->n[2] += dx;
        p->n[3] += dy;
    }
    if (point->piece + 1 < path->pieces.count && p[1].letter == 'C') {
        p[1].n[0] += dx;
        p[1].n[1] += dy;
    }
}

static int ends_of(const WrSvgPath *path)
{
    int count = 0;
    for (int i = 0; i < path->pieces.count; i++) count += path->pieces.data[i].letter != 'Z';
    return count;
}

bool wr_svg_path_remove(WrSvgPath *path, const WrSvgPoint *point)
{
    WrSvgPiece *list = path->pieces.data, *p = &list[point->piece];
    if (point->handle) { /* straight */
        const double x = p->n[end_of(p)], y = p->n[end_of(p) + 1];
        *p = (WrSvgPiece){ 'L', { x, y } };
        return true;
    }
    if (ends_of(path) <= 3) return false;
    WrSvgPiece *next = point->piece + 1 < path->pieces.count ? p + 1 : NULL;
    if (p->letter == 'M' && (!next || next->letter == 'Z' || next->letter == 'M')) return false;
    if (p->letter == 'M') { /* the subpath begins at the next point */
        const double x = next->n[end_of(next)], y = next->n[end_of(next) + 1];
        *next = (WrSvgPiece){ 'M', { x, y } };
    }
    memmove(p, p + 1, (size_t)(path->pieces.count - point->piece - 1) * sizeof *p);
    path->pieces.count--;
    return true;
}

/* ---- curves ---- */

/* Bezier curves of degree 2 and 3, by de Casteljau; n: a, handles, b as x,y pairs. */
static void bezier_at(const double *n, int degree, double t, double out[2])
{
    double q[8];
    memcpy(q, n, (size_t)(2 * degree + 2) * sizeof *q);
    for (int k = degree; k > 0; k--)
        for (int i = 0; i < 2 * k; i++) q[i] += t * (q[i + 2] - q[i]);
    out[0] = q[0];
    out[1] = q[1];
}

/* An arc by its middle: SVG 2, B.2.4 "conversion from endpoint to center parameterization". */
typedef struct Arc {
    double x, y, rx, ry, cosine, sine, from, sweep;
    bool line;
} Arc;

static Arc arc_of(const double a[2], const double *n)
{
    Arc arc = { .rx = fabs(n[0]), .ry = fabs(n[1]) };
    const double turn = n[2] * 0.017453292519943295;
    arc.cosine = wr_cos(turn);
    arc.sine = wr_sin(turn);
    const double hx = 0.5 * (a[0] - n[5]), hy = 0.5 * (a[1] - n[6]);
    const double px = arc.cosine * hx + arc.sine * hy, py = arc.cosine * hy - arc.sine * hx;
    arc.line = !(arc.rx > 0.0 && arc.ry > 0.0) || (hx == 0.0 && hy == 0.0);
    if (arc.line) return arc;
    const double scale = sqrt(px * px / (arc.rx * arc.rx) + py * py / (arc.ry * arc.ry));
    if (scale > 1.0) {
        arc.rx *= scale;
        arc.ry *= scale;
    }
    const double ux = arc.rx * py, uy = arc.ry * px, way = ux * ux + uy * uy;
    const double rest = arc.rx * arc.rx * arc.ry * arc.ry - way;
    const double root = (n[3] == n[4] ? -1.0 : 1.0) * sqrt(rest > 0.0 ? rest / way : 0.0);
    const double cx = root * arc.rx * py / arc.ry, cy = -root * arc.ry * px / arc.rx;
    arc.x = arc.cosine * cx - arc.sine * cy + 0.5 * (a[0] + n[5]);
    arc.y = arc.sine * cx + arc.cosine * cy + 0.5 * (a[1] + n[6]);
    arc.from = wr_atan2((py - cy) / arc.ry, (px - cx) / arc.rx);
    const double to = wr_atan2((-py - cy) / arc.ry, (-px - cx) / arc.rx), whole = 6.283185307179586;
    arc.sweep = to - arc.from;
    if (n[4] != 0.0 && arc.sweep < 0.0) arc.sweep += whole;
    if (n[4] == 0.0 && arc.sweep > 0.0) arc.sweep -= whole;
    return arc;
}

/* The place at t, 0..1, of a piece that begins at a. */
static void piece_at(const double a[2], const WrSvgPiece *p, double t, double out[2])
{
    const int end = end_of(p);
    if (p->letter == 'C' || p->letter == 'Q') {
        double n[8] = { a[0], a[1] };
        memcpy(n + 2, p->n, 6 * sizeof *n);
        bezier_at(n, p->letter == 'C' ? 3 : 2, t, out);
        return;
    }
    const Arc arc = p->letter == 'A' ? arc_of(a, p->n) : (Arc){ .line = true };
    const double angle = arc.from + t * arc.sweep;
    const double x = arc.rx * wr_cos(angle), y = arc.ry * wr_sin(angle);
    for (int k = 0; k < 2; k++) out[k] = a[k] + t * (p->n[end + k] - a[k]);
    if (arc.line) return;
    out[0] = arc.x + arc.cosine * x - arc.sine * y;
    out[1] = arc.y + arc.sine * x + arc.cosine * y;
}

static bool is_curve(const WrSvgPiece *p)
{
    return p->letter == 'C' || p->letter == 'Q' || p->letter == 'A';
}

/* The end of the piece before `i`, whose subpath begins at `start`. */
static void begin_of(const WrSvgPath *path, int i, double out[2])
{
    const WrSvgPiece *list = path->pieces.data;
    int k = i - 1;
    if (k >= 0 && list[k].letter == 'Z')
        while (k >= 0 && list[k].letter != 'M') k--;
    out[0] = k >= 0 ? list[k].n[end_of(&list[k])] : 0.0;
    out[1] = k >= 0 ? list[k].n[end_of(&list[k]) + 1] : 0.0;
}

void wr_svg_path_outline(const WrSvgPath *path, WrSvgOutline *out)
{
    *out = (WrSvgOutline){ { 0 }, { 0 } };
    bool open = false;
    for (int i = 0; i < path->pieces.count; i++) {
        const WrSvgPiece *p = &path->pieces.data[i];
        double a[2], b[2];
        begin_of(path, i, a);
        if (p->letter == 'Z') {
            open = false;
            continue;
        }
        if (p->letter == 'M' || !open) wr_array_push(&out->first, out->xy.count / 2);
        if (p->letter != 'M' && !open) {
            wr_array_push(&out->xy, a[0]);
            wr_array_push(&out->xy, a[1]);
        }
        open = true;
        const int steps = is_curve(p) ? STEPS : 1;
        for (int k = 1; k <= steps; k++) {
            piece_at(a, p, k == steps ? 1.0 : (double)k / steps, b);
            wr_array_push(&out->xy, b[0]);
            wr_array_push(&out->xy, b[1]);
        }
    }
}

void wr_svg_outline_fini(WrSvgOutline *outline)
{
    wr_array_free(&outline->xy);
    wr_array_free(&outline->first);
}

void wr_svg_outline_box(const WrSvgOutline *outline, double box[4])
{
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    for (int i = 0; i < outline->xy.count; i++) {
        low[i % 2] = fmin(low[i % 2], outline->xy.data[i]);
        high[i % 2] = fmax(high[i % 2], outline->xy.data[i]);
    }
    for (int k = 0; k < 2; k++) {
        box[k] = low[k];
        box[2 + k] = high[k] - low[k];
    }
}

/* ---- dividing ---- */

/* Insert a piece before `i`. */
static void insert(WrSvgPath *path, int i, WrSvgPiece piece)
{
    wr_array_push(&path->pieces, piece);
    WrSvgPiece *list = path->pieces.data;
    memmove(list + i + 1, list + i, (size_t)(path->pieces.count - 1 - i) * sizeof *list);
    list[i] = piece;
}

static void divide_at(WrSvgPath *path, int i, const double a[2], double t)
{
    WrSvgPiece *p = &path->pieces.data[i], first = *p;
    double at[2];
    piece_at(a, p, t, at);
    const int degree = p->letter == 'C' ? 3 : p->letter == 'Q' ? 2 : 1, end = end_of(p);
    first.n[end] = at[0];
    first.n[end + 1] = at[1];
    if (degree > 1) { /* the left and the right edge of de Casteljau's triangle */
        double q[8] = { a[0], a[1] };
        memcpy(q + 2, p->n, 6 * sizeof *q);
        for (int k = degree; k > 0; k--) {
            for (int n = 0; n < 2 * k; n++) q[n] += t * (q[n + 2] - q[n]);
            memcpy(first.n + 2 * (degree - k), q, 2 * sizeof *q);
        }
        memcpy(p->n, q + 2, (size_t)(2 * degree) * sizeof *q);
    }
    if (p->letter == 'A') { /* both halves turn by less than the whole */
        const Arc arc = arc_of(a, p->n);
        first.n[3] = fabs(arc.sweep) * t > 3.141592653589793;
        p->n[3] = fabs(arc.sweep) * (1.0 - t) > 3.141592653589793;
        first.n[0] = p->n[0] = arc.line ? p->n[0] : arc.rx;
        first.n[1] = p->n[1] = arc.line ? p->n[1] : arc.ry;
    }
    insert(path, i, first);
}

bool wr_svg_path_divide(WrSvgPath *path, double x, double y)
{
    double best = INFINITY, best_t = 0.0, from[2] = { 0.0, 0.0 };
    int found = -1;
    for (int i = 1; i < path->pieces.count; i++) {
        const WrSvgPiece *p = &path->pieces.data[i];
        double a[2], b[2];
        begin_of(path, i, a);
        if (p->letter == 'M') continue;
        WrSvgPiece line = { .letter = 'L' };
        begin_of(path, i + 1, line.n); /* Z: straight to the start */
        for (int k = 1; k < STEPS; k++) {
            const double t = (double)k / STEPS;
            piece_at(a, p->letter == 'Z' ? &line : p, t, b);
            const double way = wr_hypot(b[0] - x, b[1] - y);
            if (way >= best) continue;
            best = way;
            best_t = t;
            found = i;
            memcpy(from, a, sizeof from);
        }
    }
    if (found < 0) return false;
    if (path->pieces.data[found].letter == 'Z') {
        WrSvgPiece line = { .letter = 'L' }, middle = { .letter = 'L' };
        begin_of(path, found + 1, line.n);
        piece_at(from, &line, best_t, middle.n);
        insert(path, found, middle);
    } else {
        divide_at(path, found, from, best_t);
    }
    return true;
}
