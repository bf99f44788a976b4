/* Recording and replay of pen events in a text file. */
#include "ui/input/pen.h"
#include "ui/input/pen_internal.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "system/clock.h"
#include "system/fd.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FIRST_LINE "wrinkle-pen 1"
#define MAX_FILE ((size_t)256 << 20) /* bytes */
#define DEVICES_MAX 64
#define FIELDS_LEAST 10 /* without the turn */
#define FIELDS_MAX 15   /* of a grip */
#define PLACE_MAX 1e6   /* pixels */

WR_ROWS(event_names);
static const char *const event_names[WR_PEN_KINDS] = {
    [WR_ROW(WR_PEN_MOTION)] = "motion", [WR_ROW(WR_PEN_DOWN)] = "down",
    [WR_ROW(WR_PEN_UP)] = "up",         [WR_ROW(WR_PEN_LOST)] = "lost",
    [WR_ROW(WR_PEN_CANCEL)] = "cancel", [WR_ROW(WR_PEN_GRIP)] = "grip",
    [WR_ROW(WR_PEN_TAP)] = "tap"
};
WR_ROWS_END(event_names, WR_PEN_KINDS);
#define DEVICES(X) X(PEN, "pen") X(ERASER, "eraser") X(FINGER, "finger")
enum { DEVICES(WR_WORD_ID) };
static const char *const device_names[] = { DEVICES(WR_WORD) };

/* ---- recording ---- */

bool wr_pen_record(WrPen *pen, const char *path, WrError *err)
{
    if (pen->record) {
        if (fclose(pen->record) != 0) pen->record_failed = true;
        pen->record = NULL;
        wr_array_free(&pen->recorded);
        if (pen->record_failed)
            return wr_fail(err, "the recording of the pen is incomplete: it could not be written");
    }
    if (path[0] == '\0') return true;
    int fd = wr_file_open_truncate(path, err);
    if (fd < 0) return false;
    FILE *file = wr_fd_stream(fd, "w");
    if (!file) {
        wr_fd_close(fd);
        return wr_fail(err, "%s: cannot be written: %s", path, strerror(errno));
    }
    setvbuf(file, NULL, _IOLBF, 1 << 14);
    pen->record_failed = fputs(FIRST_LINE "\n", file) < 0;
    pen->record = file;
    return true;
}

static void declare(WrPen *pen, int index, WrText *line)
{
    while (pen->recorded.count <= index) wr_array_push(&pen->recorded, false);
    if (pen->recorded.data[index]) return;
    pen->recorded.data[index] = true;
    const WrPenDevice *d = &pen->units.data[index].shown;
    wr_text_addf(line, "device %d %s %d %d ", index,
                 device_names[d->finger   ? FINGER
                              : d->eraser ? ERASER
                                          : PEN],
                 d->has_pressure, d->has_tilt);
    wr_text_add_number(line, d->pressure_low);
    wr_text_add(line, " ");
    wr_text_add_number(line, d->pressure_high);
    wr_text_addf(line, " %s\n", d->name);
}

void wr_pen_record_event(WrPen *pen, const WrPenEvent *e)
{
    if (!pen->record) return;
    WrText line = { 0 };
    declare(pen, e->device, &line);
    wr_text_addf(&line, "%s ", event_names[e->kind]);
    wr_text_add_number(&line, e->seconds);
    wr_text_addf(&line, " %d %d %u", e->device, e->button, e->held);
    const WrGrip *g = &e->grip;
    const double numbers[] = { e->x,        e->y,  e->raw, e->pressure, e->tilt_x,  e->tilt_y,
                               e->turn_deg, g->dx, g->dy,  g->scale,    g->turn_deg };
    const size_t count = e->kind == WR_PEN_GRIP ? 11 : e->turn_deg != 0.0 ? 7 : 6;
    for (size_t i = 0; i < count; i++) {
        wr_text_add(&line, " ");
        wr_text_add_number(&line, numbers[i]);
    }
    wr_text_add(&line, "\n");
    if (fputs(wr_text_get(&line), pen->record) < 0) pen->record_failed = true;
    wr_text_fini(&line);
}

/* ---- parsing ---- */

typedef struct FileDevice {
    bool declared;
    int kind; /* PEN, ERASER, FINGER */
    bool has_pressure, has_tilt;
    double low, high;
    char name[96];
    unsigned held;
    double seconds;
} FileDevice;

typedef WR_ARRAY(WrPenEvent) Events;

typedef struct Reader {
    FileDevice devices[DEVICES_MAX];
    Events events; /* `device` is the file's index */
} Reader;

typedef struct Field {
    const char *text;
    size_t length;
} Field;

/* The next field of a line; false at its end. */
static bool next_field(const char **at, const char *end, Field *field)
{
    while (*at < end && **at == ' ') (*at)++;
    field->text = *at;
    while (*at < end && **at != ' ') (*at)++;
    field->length = (size_t)(*at - field->text);
    return field->length > 0;
}

static bool is_word(const Field *f, const char *word)
{
    return strlen(word) == f->length && memcmp(f->text, word, f->length) == 0;
}

static int word_of(const Field *f, const char *const *words, int count)
{
    for (int i = 0; i < count; i++)
        if (is_word(f, words[i])) return i;
    return -1;
}

static bool number_of(const Field *f, const char *name, double low, double high, double *value,
                      WrError *err)
{
    double v;
    if (!wr_number_parse(f->text, f->length, &v) || !(v >= low && v <= high))
        return wr_fail(err, "%s '%.*s': a number %g..%g", name,
                       f->length < 40 ? (int)f->length : 40, f->text, low, high);
    *value = v;
    return true;
}

static bool whole_of(const Field *f, const char *name, int high, int *value, WrError *err)
{
    double v;
    if (!number_of(f, name, 0.0, high, &v, err)) return false;
    if (v != floor(v)) return wr_fail(err, "%s %g: a whole number 0..%d", name, v, high);
    *value = (int)v;
    return true;
}

/* Parse: device INDEX KIND PRESSURE TILT LOW HIGH NAME */
static bool read_device(Reader *reader, const char *at, const char *end, WrError *err)
{
    Field f[6];
    int index, pressure, tilt;
    double low = 0, high = 0;
    for (int i = 0; i < 6; i++)
        if (!next_field(&at, end, &f[i]))
            return wr_fail(err, "a device is: device INDEX KIND PRESSURE TILT LOW HIGH NAME");
    if (!whole_of(&f[0], "device", DEVICES_MAX - 1, &index, err)) return false;
    int kind = word_of(&f[1], device_names, WR_LENGTH(device_names));
    if (kind < 0)
        return wr_fail(err, "device of kind '%.*s': pen, eraser or finger",
                       f[1].length < 40 ? (int)f[1].length : 40, f[1].text);
    if (!whole_of(&f[2], "pressure", 1, &pressure, err) ||
        !whole_of(&f[3], "tilt", 1, &tilt, err) ||
        !number_of(&f[4], "lowest pressure", -1e9, 1e9, &low, err) ||
        !number_of(&f[5], "highest pressure", -1e9, 1e9, &high, err))
        return false;
    while (at < end && *at == ' ') at++;
    FileDevice *d = &reader->devices[index];
    if (at == end || (size_t)(end - at) >= sizeof d->name)
        return wr_fail(err, "device %d: a name of 1..%d bytes", index, (int)sizeof d->name - 1);
    if (d->declared) return wr_fail(err, "device %d: is already declared", index);
    *d = (FileDevice){ .declared = true,
                       .kind = kind,
                       .has_pressure = pressure == 1,
                       .has_tilt = tilt == 1,
                       .low = low,
                       .high = high };
    memcpy(d->name, at, (size_t)(end - at));
    return true;
}

/* True if the event is possible in the device's state; updates the state. */
static bool follows(FileDevice *d, const WrPenEvent *e, WrError *err)
{
    bool button = e->kind == WR_PEN_DOWN || e->kind == WR_PEN_UP;
    unsigned bit = button ? 1u << e->button : 0u;
    const bool counts = e->kind == WR_PEN_GRIP || e->kind == WR_PEN_TAP;
    if (!counts && button != (e->button != 0))
        return wr_fail(err, "button %d: 1..%d for down and up, else 0", e->button, WR_PEN_BUTTONS);
    if (button && ((d->held & bit) != 0) == (e->kind == WR_PEN_DOWN))
        return wr_fail(err, "button %d of device %d is %s already", e->button, e->device,
                       e->kind == WR_PEN_DOWN ? "down" : "up");
    const bool ends = e->kind == WR_PEN_LOST || e->kind == WR_PEN_CANCEL;
    unsigned held = ends ? 0 : e->kind == WR_PEN_UP ? d->held & ~bit : d->held | bit;
    if (e->held != held)
        return wr_fail(err, "held %u: by the events before it is %u", e->held, held);
    if (e->seconds < d->seconds)
        return wr_fail(err, "%g seconds: device %d was at %g already", e->seconds, e->device,
                       d->seconds);
    d->held = held;
    d->seconds = e->seconds;
    return true;
}

static bool read_grip(const Field f[4], WrGrip *grip, WrError *err)
{
    return number_of(&f[0], "dx", -PLACE_MAX, PLACE_MAX, &grip->dx, err) &&
           number_of(&f[1], "dy", -PLACE_MAX, PLACE_MAX, &grip->dy, err) &&
           number_of(&f[2], "scale", 1e-3, 1e3, &grip->scale, err) &&
           number_of(&f[3], "turn", -180, 180, &grip->turn_deg, err);
}

/* Parse: EVENT SECONDS INDEX BUTTON HELD X Y RAW PRESSURE TILT_X TILT_Y [TURN [DX DY SCALE GRIP_TURN]] */
static bool read_event(Reader *reader, const Field *name, const char *at, const char *end,
                       WrError *err)
{
    Field f[FIELDS_MAX + 1];
    int held, count = 0, kind = word_of(name, event_names, WR_PEN_KINDS);
    WrPenEvent e = { 0 };
    if (kind < 0)
        return wr_fail(err, "'%.*s': device, motion, down, up, lost, cancel, grip or tap",
                       name->length < 40 ? (int)name->length : 40, name->text);
    while (count <= FIELDS_MAX && next_field(&at, end, &f[count])) count++;
    const bool grips = kind == WR_PEN_GRIP;
    if (grips ? count != FIELDS_MAX : count != FIELDS_LEAST && count != FIELDS_LEAST + 1)
        return wr_fail(
            err, grips ? "a grip has 15 numbers, not %d" : "an event has 10 or 11 numbers, not %d",
            count);
    e.kind = (WrPenKind)kind;
    if (!number_of(&f[0], "seconds", 0, 1e12, &e.seconds, err) ||
        !whole_of(&f[1], "device", DEVICES_MAX - 1, &e.device, err) ||
        !whole_of(&f[2], "button", kind == WR_PEN_TAP ? WR_FINGERS : WR_PEN_BUTTONS, &e.button,
                  err) ||
        !whole_of(&f[3], "held", (1 << (WR_PEN_BUTTONS + 1)) - 1, &held, err) ||
        !number_of(&f[4], "x", -PLACE_MAX, PLACE_MAX, &e.x, err) ||
        !number_of(&f[5], "y", -PLACE_MAX, PLACE_MAX, &e.y, err) ||
        !number_of(&f[6], "raw pressure", 0, 1, &e.raw, err) ||
        !number_of(&f[7], "pressure", 0, 1, &e.pressure, err) ||
        !number_of(&f[8], "tilt x", -1, 1, &e.tilt_x, err) ||
        !number_of(&f[9], "tilt y", -1, 1, &e.tilt_y, err))
        return false;
    if (count > FIELDS_LEAST && !number_of(&f[10], "turn", -180, 180, &e.turn_deg, err))
        return false;
    if (grips && !read_grip(&f[11], &e.grip, err)) return false;
    FileDevice *d = &reader->devices[e.device];
    if (!d->declared) return wr_fail(err, "device %d: is not declared", e.device);
    e.held = (unsigned)held;
    e.eraser = d->kind == ERASER;
    e.finger = d->kind == FINGER;
    if (!follows(d, &e, err)) return false;
    wr_array_push(&reader->events, e);
    return true;
}

static bool read_line(Reader *reader, int number, const char *line, const char *end, WrError *err)
{
    Field word;
    const char *at = line;
    if (end > line && end[-1] == '\r') end--;
    if (number == 1) {
        Field whole = { line, (size_t)(end - line) };
        return is_word(&whole, FIRST_LINE) ||
               wr_fail(err, "the first line of a recording must be '%s'", FIRST_LINE);
    }
    if (!next_field(&at, end, &word) || word.text[0] == '#') return true;
    if (is_word(&word, "device")) return read_device(reader, at, end, err);
    return read_event(reader, &word, at, end, err);
}

static bool read_all(Reader *reader, const char *bytes, size_t length, const char *path,
                     WrError *err)
{
    WrError inner = { "" };
    int number = 1;
    for (const char *at = bytes, *end = bytes + length; number == 1 || at < end; number++) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        if (!stop) stop = end;
        if (!read_line(reader, number, at, stop, &inner))
            return wr_fail(err, "%s:%d: %s", path, number, wr_error_message(&inner));
        at = stop < end ? stop + 1 : end;
    }
    if (reader->events.count == 0) return wr_fail(err, "%s: contains no event", path);
    return true;
}

/* ---- replay ---- */

/* Map devices of the file to devices of the pen. */
static void take_devices(WrPen *pen, Reader *reader)
{
    int index[DEVICES_MAX] = { 0 };
    for (int i = 0; i < DEVICES_MAX; i++) {
        const FileDevice *d = &reader->devices[i];
        if (!d->declared) continue;
        int known = pen->units.count;
        index[i] = wr_pen_unit(pen, d->name, d->kind == 1, d->kind == 2);
        if (index[i] < known) continue;
        WrPenUnit *unit = &pen->units.data[index[i]];
        unit->replayed = unit->shown.there = unit->shown.has_place = true;
        unit->shown.has_pressure = d->has_pressure;
        unit->shown.has_tilt = d->has_tilt;
        unit->shown.pressure_low = d->low;
        unit->shown.pressure_high = d->high;
    }
    for (int i = 0; i < reader->events.count; i++)
        reader->events.data[i].device = index[reader->events.data[i].device];
}

void wr_pen_replay_end(WrPen *pen)
{
    wr_array_free(&pen->replay.events);
    pen->replay = (WrPenReplay){ .next = 0 };
}

bool wr_pen_replay(WrPen *pen, const char *path, double speed, WrError *err)
{
    if (!(speed >= 0.0 && speed <= 1e6))
        return wr_fail(err, "a replay %g times as fast: must be 0..1000000", speed);
    Reader *reader = NULL;
    char *bytes = NULL;
    size_t length = 0;
    bool ok = true;
    if (path[0]) {
        reader = wr_alloc(1, sizeof *reader);
        ok = wr_file_read(path, MAX_FILE, &bytes, &length, err) &&
             read_all(reader, bytes, length, path, err);
    }
    if (ok) {
        wr_pen_replay_end(pen);
        for (int i = 0; i < pen->units.count; i++) wr_pen_lose(pen, i);
    }
    if (ok && reader) {
        take_devices(pen, reader);
        pen->replay.events.data = reader->events.data;
        pen->replay.events.count = reader->events.count;
        pen->replay.events.capacity = reader->events.capacity;
        reader->events = (Events){ 0 };
        pen->replay.speed = speed;
    }
    if (reader) wr_array_free(&reader->events);
    wr_free(reader);
    wr_free(bytes);
    return ok;
}

bool wr_pen_replaying(const WrPen *pen)
{
    return pen->replay.events.count > 0;
}

static void replay_one(WrPen *pen, const WrPenEvent *e)
{
    WrPenUnit *unit = &pen->units.data[e->device];
    wr_pen_watch(unit, e->raw, (e->held & 2u) != 0);
    unit->held = e->held;
    unit->shown.events++;
    if (e->kind == WR_PEN_DOWN && e->button == 1) unit->shown.presses++;
    wr_pen_push(pen, e);
}

/* Release buttons still held at the end of the file. */
static void finish(WrPen *pen)
{
    const WrPenReplay *replay = &pen->replay;
    for (int i = 0; i < pen->units.count; i++) {
        if (!pen->units.data[i].held) continue;
        WrPenEvent last = { 0 };
        for (int k = 0; k < replay->events.count; k++)
            if (replay->events.data[k].device == i) last = replay->events.data[k];
        last.kind = WR_PEN_LOST;
        last.button = 0;
        last.held = 0;
        replay_one(pen, &last);
    }
    wr_pen_replay_end(pen);
}

void wr_pen_replay_step(WrPen *pen)
{
    WrPenReplay *replay = &pen->replay;
    double now = wr_clock_seconds();
    if (replay->began_at == 0.0) replay->began_at = now;
    double passed = now - replay->began_at - replay->delay;
    if (passed < 0.0) return;
    while (replay->next < replay->events.count) {
        const WrPenEvent *e = &replay->events.data[replay->next];
        bool due = replay->speed > 0.0
                       ? e->seconds - replay->events.data[0].seconds <= passed * replay->speed
                       : pen->taken >= pen->queue.count;
        if (!due) return;
        WrPenEvent copy = *e;
        replay->next++;
        replay_one(pen, &copy);
    }
    if (pen->taken >= pen->queue.count) finish(pen);
}

void wr_pen_record_start(WrPen *pen)
{
    WrError err;
    const char *to = getenv("WRINKLE_PEN_RECORD"), *from = getenv("WRINKLE_PEN_REPLAY");
    if (to && to[0] && !wr_pen_record(pen, to, &err)) fprintf(stderr, "wrinkle: %s\n", err.text);
    if (!from || !from[0]) return;
    if (wr_pen_replay(pen, from, 1.0, &err))
        pen->replay.delay = 1.0; /* after the window is drawn */
    else fprintf(stderr, "wrinkle: %s\n", err.text);
}
