#include "ui/app/state/settings.h"
#include "ui/app/state/workspace.h"
#include "ui/canvas/canvas.h"
#include "ui/input/stroke_smoothing.h"

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/brush.h"
#include "system/fd.h"
#include "system/path.h"
#include "system/thread.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

WrSettings wr_settings_default(void)
{
    return (WrSettings){
        .width = 1440,
        .height = 900,
        .divider = 0.5,
        .panels = true,
        .lower = 0.52, /* six layers in a window of 1280 x 800 */
        .ants = true,
        .grid_parts = 8,
        .snap = true,
        .turning = true,
        .brush = wr_brush_default(),
        .mask_strength = 1.0,
        .lock_size = false,
        .symmetry = { .mirror_u = true,
                      .radial = 1,
                      .centre_u = 0.5,
                      .centre_v = 0.5,
                      .repeat_u = 1,
                      .repeat_v = 1 },
        .mesh_mirror = { true },
        .drawing = { .closed = true, .tolerance = 0.01, .high = 1.0 },
        .steady_smooth = 24.0,
        .steady_string = 40.0,
        .fake = { .slow = 60.0, .fast = 2000.0, .least = 0.15, .held = 1.0, .now = 1.0 },
        .look = { .automatic = { true, true },
                  .marks = true,
                  .high = 1.0,
                  .light_x = -0.5,
                  .light_y = 0.6 }
    };
}

/* ---- lines ---- */

/* A numeric setting: its variable and range. */
typedef struct Row {
    const char *name;
    double *real; /* one of real, whole, flag is set */
    int *whole;
    bool *flag;
    double low, high;
} Row;

#define ROWS_MAX 112

/* Rows of the window as a whole. */
static int window_rows(WrSettings *s, Row *rows)
{
    const Row some[] = {
        { "width", NULL, &s->width, NULL, 320, 32768 },
        { "height", NULL, &s->height, NULL, 240, 32768 },
        { "maximized", NULL, NULL, &s->maximized, 0, 1 },
        { "scale", &s->scale, NULL, NULL, 0, 3 },
        { "theme", NULL, (int *)&s->theme, NULL, 0, WR_THEME_KINDS - 1 },
        { "language", NULL, &s->language, NULL, 0, 63 },
        { "dialogs", NULL, &s->dialogs, NULL, 0, 2 },
        { "panels", NULL, NULL, &s->panels, 0, 1 },
        { "workspace", NULL, &s->workspace, NULL, 0, WR_WORKSPACES - 1 },
        { "ants", NULL, NULL, &s->ants, 0, 1 },
        { "grid", NULL, NULL, &s->grid, 0, 1 },
        { "grid_parts", NULL, &s->grid_parts, NULL, 1, 256 },
        { "snap", NULL, NULL, &s->snap, 0, 1 },
        { "history_lines", NULL, NULL, &s->history_lines, 0, 1 },
        { "tiling", NULL, (int *)&s->tiling, NULL, 0, WR_TILINGS - 1 },
        { "join", NULL, &s->join, NULL, 0, 3 },
        { "turning", NULL, NULL, &s->turning, 0, 1 },
    };
    memcpy(rows, some, sizeof some);
    return WR_LENGTH(some);
}

/* Rows of the places in the window. */
static int place_rows(WrSettings *s, Row *rows)
{
    const Row some[] = {
        { "divider", &s->divider, NULL, NULL, 0, 1 },
        { "views", NULL, (int *)&s->views, NULL, 0, 2 },
        { "tab", NULL, &s->tab, NULL, 0, 15 },
        { "inspector", NULL, NULL, &s->inspector, 0, 1 },
        { "lower", &s->lower, NULL, NULL, 0, 0.95 },
        { "side_width", &s->side_width, NULL, NULL, -1, 32768 },
        { "side_left", NULL, NULL, &s->side_left, 0, 1 },
        { "hide_strip", NULL, NULL, &s->hide_strip, 0, 1 },
        { "hide_options", NULL, NULL, &s->hide_options, 0, 1 },
        { "meters", NULL, NULL, &s->meters, 0, 1 },
    };
    memcpy(rows, some, sizeof some);
    return WR_LENGTH(some);
}

/* Rows of the brush. */
static int brush_rows(WrSettings *s, Row *rows)
{
    const Row some[] = {
        { "radius", &s->brush.radius, NULL, NULL, 0, 1e9 },
        { "hardness", &s->brush.hardness, NULL, NULL, 0, 1 },
        { "strength", &s->brush.strength, NULL, NULL, -1e30, 1e30 },
        { "mode", NULL, (int *)&s->brush.mode, NULL, 0, WR_BRUSH_MODE_COUNT - 1 },
        { "to", &s->brush.to, NULL, NULL, -1e30, 1e30 },
        { "opacity", &s->brush.opacity, NULL, NULL, 0, 1 },
        { "flow", &s->brush.flow, NULL, NULL, 0, 1 },
        { "buildup", NULL, NULL, &s->brush.buildup, 0, 1 },
        { "spacing", &s->brush.spacing, NULL, NULL, 0, 10 },
        { "reach", &s->brush.reach, NULL, NULL, 0, 1e9 },
        { "pressure", NULL, (int *)&s->brush.pressure, NULL, 0, WR_PRESSURE_COUNT - 1 },
        { "source_u", &s->brush.source_u, NULL, NULL, -1e9, 1e9 },
        { "source_v", &s->brush.source_v, NULL, NULL, -1e9, 1e9 },
        { "angle", &s->brush.angle_deg, NULL, NULL, -1e9, 1e9 },
        { "aspect", &s->brush.aspect, NULL, NULL, 1, 1e9 },
        { "follow", NULL, NULL, &s->brush.follow, 0, 1 },
        { "jitter_place", &s->brush.jitter_place, NULL, NULL, 0, 1e9 },
        { "jitter_angle", &s->brush.jitter_angle_deg, NULL, NULL, 0, 180 },
        { "jitter_size", &s->brush.jitter_size, NULL, NULL, 0, 1 },
        { "mask_strength", &s->mask_strength, NULL, NULL, 0, 1 },
        { "other_strength", &s->other_strength, NULL, NULL, -1e30, 1e30 },
        { "lock_size", NULL, NULL, &s->lock_size, 0, 1 },
    };
    memcpy(rows, some, sizeof some);
    return WR_LENGTH(some);
}

/* Rows of symmetry and drawing tools. */
static int drawing_rows(WrSettings *s, Row *rows)
{
    const Row some[] = {
        { "symmetric", NULL, NULL, &s->symmetric, 0, 1 },
        { "symmetry_panel", NULL, NULL, &s->symmetry_panel, 0, 1 },
        { "mirror_u", NULL, NULL, &s->symmetry.mirror_u, 0, 1 },
        { "mirror_v", NULL, NULL, &s->symmetry.mirror_v, 0, 1 },
        { "radial", NULL, &s->symmetry.radial, NULL, 1, 360 },
        { "centre_u", &s->symmetry.centre_u, NULL, NULL, 0, 1 },
        { "centre_v", &s->symmetry.centre_v, NULL, NULL, 0, 1 },
        { "repeat_u", NULL, &s->symmetry.repeat_u, NULL, 1, 64 },
        { "repeat_v", NULL, &s->symmetry.repeat_v, NULL, 1, 64 },
        { "stagger", &s->symmetry.stagger, NULL, NULL, 0, 1 },
        { "mirror_x", NULL, NULL, &s->mesh_mirror[0], 0, 1 },
        { "mirror_y", NULL, NULL, &s->mesh_mirror[1], 0, 1 },
        { "mirror_z", NULL, NULL, &s->mesh_mirror[2], 0, 1 },
        { "key_map", NULL, &s->key_map, NULL, 0, 7 },
        { "fills", NULL, NULL, &s->drawing.fills, 0, 1 },
        { "closed", NULL, NULL, &s->drawing.closed, 0, 1 },
        { "corner", &s->drawing.corner, NULL, NULL, 0, 1e9 },
        { "tolerance", &s->drawing.tolerance, NULL, NULL, 0, 1e30 },
        { "diagonal", NULL, NULL, &s->drawing.diagonal, 0, 1 },
        { "ramp", NULL, &s->drawing.ramp, NULL, 0, 2 },
        { "ramp_blend", NULL, &s->drawing.blend, NULL, 0, 3 },
        { "ramp_fold", NULL, NULL, &s->drawing.fold, 0, 1 },
        { "ramp_low", &s->drawing.low, NULL, NULL, -1e30, 1e30 },
        { "ramp_high", &s->drawing.high, NULL, NULL, -1e30, 1e30 },
    };
    memcpy(rows, some, sizeof some);
    return WR_LENGTH(some);
}

/* Rows of the pointer and the views. */
static int view_rows(WrSettings *s, Row *rows)
{
    const Row some[] = {
        { "steady", NULL, &s->steady, NULL, 0, WR_SMOOTHING_COUNT - 1 },
        { "steady_smooth", &s->steady_smooth, NULL, NULL, 1, 1000 },
        { "steady_string", &s->steady_string, NULL, NULL, 1, 1000 },
        { "steady_catch_up", NULL, NULL, &s->steady_catch_up, 0, 1 },
        { "mouse_pressure", NULL, NULL, &s->fake.by_speed, 0, 1 },
        { "mouse_slow", &s->fake.slow, NULL, NULL, 1, 1e5 },
        { "mouse_fast", &s->fake.fast, NULL, NULL, 2, 1e5 },
        { "mouse_least", &s->fake.least, NULL, NULL, 0, 1 },
        { "shown", NULL, (int *)&s->look.shown, NULL, 0, WR_CANVAS_SHOWN - 1 },
        { "colours", NULL, (int *)&s->look.colours, NULL, 0, WR_CANVAS_LOOKS - 1 },
        { "range_follows", NULL, NULL, &s->look.automatic[0], 0, 1 },
        { "range_follows_white", NULL, NULL, &s->look.automatic[1], 0, 1 },
        { "range_marks", NULL, NULL, &s->look.marks, 0, 1 },
        { "light_x", &s->look.light_x, NULL, NULL, -1, 1 },
        { "light_y", &s->look.light_y, NULL, NULL, -1, 1 },
        { "low", &s->look.low, NULL, NULL, -1e30, 1e30 },
        { "high", &s->look.high, NULL, NULL, -1e30, 1e30 },
    };
    memcpy(rows, some, sizeof some);
    return WR_LENGTH(some);
}

static int rows_of(WrSettings *s, Row rows[ROWS_MAX])
{
    int count = window_rows(s, rows);
    count += place_rows(s, rows + count);
    count += brush_rows(s, rows + count);
    count += drawing_rows(s, rows + count);
    return count + view_rows(s, rows + count);
}

static void take(WrSettings *settings, const char *name, size_t name_length, const char *value,
                 size_t length)
{
    Row rows[ROWS_MAX];
    int count = rows_of(settings, rows);
    double number;
    if (!wr_number_parse(value, length, &number)) return;
    for (int i = 0; i < count; i++) {
        if (strlen(rows[i].name) != name_length || strncmp(rows[i].name, name, name_length) != 0)
            continue;
        if (!(number >= rows[i].low && number <= rows[i].high)) return;
        if (rows[i].real) *rows[i].real = number;
        if (rows[i].whole) *rows[i].whole = (int)number;
        if (rows[i].flag) *rows[i].flag = number != 0.0;
        return;
    }
}

/* Text settings and text lists, in the order of their lines. */
typedef struct TextRow {
    const char *name;
    char **texts;
    int most;
    bool shared; /* additions by other windows are taken over */
    /* newest first: move an entry to the front */
    void (*note)(WrSettings *settings, const char *text);
} TextRow;

#define TEXT_ROWS 13

static void text_rows_of(WrSettings *s, TextRow rows[TEXT_ROWS])
{
    const TextRow all[TEXT_ROWS] = {
        { "recent", s->recent, WR_RECENT_MAX, true, wr_settings_add_recent },
        { "pen", s->pens, WR_PENS_MAX, true, NULL },
        { "favourite", s->favourites, WR_FAVOURITES_MAX, true, NULL },
        { "used", s->used, WR_USED_MAX, true, wr_settings_note_used },
        { "font", s->fonts, WR_FONTS_MAX, true, wr_settings_note_font },
        { "window_font", s->window_fonts, WR_GUI_FONT_FILES, false, NULL },
        { "preset", &s->preset, 1, false, NULL },
        { "tip", &s->tip, 1, false, NULL },
        { "set", &s->set, 1, false, NULL },
        { "fold", s->folds, WR_FOLDS_MAX, false, NULL },
        { "float", s->floats, WR_FLOATS_MAX, false, NULL },
        { "placed", s->workspaces, WR_WORKSPACES_MAX, false, NULL },
        { "pin", s->pins, WR_PINS_MAX, false, NULL }
    };
    memcpy(rows, all, sizeof all);
}

static void clear_texts(const TextRow *row)
{
    for (int i = 0; i < row->most; i++) {
        wr_free(row->texts[i]);
        row->texts[i] = NULL;
    }
}

void wr_settings_fini(WrSettings *settings)
{
    TextRow rows[TEXT_ROWS];
    text_rows_of(settings, rows);
    for (int i = 0; i < TEXT_ROWS; i++) clear_texts(&rows[i]);
    *settings = (WrSettings){ 0 };
}

static bool take_text(WrSettings *settings, const char *name, size_t name_length, const char *value,
                      size_t length)
{
    TextRow rows[TEXT_ROWS];
    text_rows_of(settings, rows);
    for (int i = 0; i < TEXT_ROWS; i++) {
        if (strlen(rows[i].name) != name_length || strncmp(rows[i].name, name, name_length) != 0)
            continue;
        int at = 0;
        while (at < rows[i].most && rows[i].texts[at]) at++;
        if (at < rows[i].most && length > 0) rows[i].texts[at] = wr_strndup(value, length);
        return true;
    }
    return false;
}

void wr_settings_parse(WrSettings *settings, const char *text)
{
    for (const char *at = text; *at;) {
        size_t length = strcspn(at, "\n"), name = strcspn(at, " \n");
        if (name < length) {
            const char *value = at + name + 1;
            if (!take_text(settings, at, name, value, length - name - 1))
                take(settings, at, name, value, length - name - 1);
        }
        at += length + (at[length] == '\n');
    }
    if (!(settings->look.low < settings->look.high)) {
        settings->look.low = 0.0;
        settings->look.high = 1.0;
    }
}

static void print_rows(const Row *rows, int count, WrText *text)
{
    for (int i = 0; i < count; i++) {
        wr_text_addf(text, "%s ", rows[i].name);
        wr_text_add_number(text, rows[i].real    ? *rows[i].real
                                 : rows[i].whole ? *rows[i].whole
                                                 : *rows[i].flag);
        wr_text_add(text, "\n");
    }
}

static void print_texts(const TextRow *row, WrText *text)
{
    for (int k = 0; k < row->most && row->texts[k]; k++)
        if (!strchr(row->texts[k], '\n')) wr_text_addf(text, "%s %s\n", row->name, row->texts[k]);
}

void wr_settings_print(const WrSettings *settings, WrText *text)
{
    WrSettings copy = *settings; /* rows point into a struct, so a copy protects the original */
    Row rows[ROWS_MAX];
    TextRow texts[TEXT_ROWS];
    print_rows(rows, rows_of(&copy, rows), text);
    text_rows_of(&copy, texts);
    for (int i = 0; i < TEXT_ROWS; i++) print_texts(&texts[i], text);
}

/* ---- places ---- */

static bool is_place(const TextRow *row)
{
    return strcmp(row->name, "fold") == 0 || strcmp(row->name, "float") == 0;
}

void wr_settings_place_print(const WrSettings *settings, WrText *text)
{
    WrSettings copy = *settings;
    WrText lines = { 0 };
    Row rows[ROWS_MAX];
    TextRow texts[TEXT_ROWS];
    print_rows(rows, place_rows(&copy, rows), &lines);
    text_rows_of(&copy, texts);
    for (int i = 0; i < TEXT_ROWS; i++)
        if (is_place(&texts[i])) print_texts(&texts[i], &lines);
    for (const char *c = wr_text_get(&lines); *c; c++)
        wr_text_add_n(text, *c == '\n' ? "\t" : c, 1);
    wr_text_fini(&lines);
}

void wr_settings_place_parse(WrSettings *settings, const char *text)
{
    char *lines = wr_strdup(text);
    TextRow texts[TEXT_ROWS];
    text_rows_of(settings, texts);
    for (int i = 0; i < TEXT_ROWS; i++)
        if (is_place(&texts[i])) clear_texts(&texts[i]);
    for (char *c = lines; *c; c++)
        if (*c == '\t') *c = '\n';
    wr_settings_parse(settings, lines);
    wr_free(lines);
}

/* ---- files ---- */

void wr_settings_load(WrSettings *settings)
{
    char *path = wr_config_path("window.conf"), *bytes = NULL;
    size_t length;
    if (path && wr_file_read(path, WR_SETTINGS_FILE_MAX, &bytes, &length, NULL))
        wr_settings_parse(settings, bytes);
    wr_free(bytes);
    wr_free(path);
}

/* mkdir -p */
static void make_folders(const char *path)
{
    char *copy = wr_strdup(path);
    for (char *c = copy + 1; *c; c++) {
        if (*c != '/') continue;
        *c = '\0';
        wr_folder_make(copy, WR_FOLDER_FOR_ME);
        *c = '/';
    }
    wr_folder_make(copy, WR_FOLDER_FOR_ME);
    wr_free(copy);
}

void wr_settings_make_folder(void)
{
    char *folder = wr_config_path("");
    if (folder) make_folders(folder);
    wr_free(folder);
}

/* Move a text to the front of a list; the last entry of a full list is dropped. */
static void put_first(char **list, int most, const char *text)
{
    char *first = wr_strdup(text);
    int at = 0;
    while (at < most - 1 && list[at] && strcmp(list[at], text) != 0) at++;
    wr_free(list[at]);
    memmove(list + 1, list, (size_t)at * sizeof *list);
    list[0] = first;
}

void wr_settings_add_recent(WrSettings *settings, const char *path)
{
    put_first(settings->recent, WR_RECENT_MAX, path);
}

void wr_settings_note_used(WrSettings *settings, const char *id)
{
    put_first(settings->used, WR_USED_MAX, id);
}

void wr_settings_note_font(WrSettings *settings, const char *font)
{
    put_first(settings->fonts, WR_FONTS_MAX, font);
}

void wr_settings_set_text(char **text, const char *value)
{
    char *fresh = value ? wr_strdup(value) : NULL; /* value may be *text */
    wr_free(*text);
    *text = fresh;
}

int wr_settings_find_favourite(const WrSettings *settings, const char *id)
{
    for (int i = 0; i < WR_FAVOURITES_MAX && settings->favourites[i]; i++)
        if (strcmp(settings->favourites[i], id) == 0) return i;
    return -1;
}

void wr_settings_set_favourite(WrSettings *settings, const char *id, bool favourite)
{
    char **list = settings->favourites;
    int at = wr_settings_find_favourite(settings, id), count = 0;
    while (count < WR_FAVOURITES_MAX && list[count]) count++;
    if (favourite && at < 0 && count < WR_FAVOURITES_MAX) list[count] = wr_strdup(id);
    if (favourite || at < 0) return;
    wr_free(list[at]);
    memmove(list + at, list + at + 1, (size_t)(count - at - 1) * sizeof *list);
    list[count - 1] = NULL;
}

#define CURVE_NUMBERS 7

const char *wr_settings_pen_name(const char *line)
{
    for (int i = 0; i < CURVE_NUMBERS; i++) {
        line = strchr(line, ' ');
        if (!line) return NULL;
        line++;
    }
    return line;
}

void wr_settings_keep_pen(WrSettings *settings, const char *line)
{
    char **pens = settings->pens, *kept = wr_strdup(line);
    const char *name = wr_settings_pen_name(kept);
    int at = 0;
    while (at < WR_PENS_MAX && pens[at]) {
        const char *other = wr_settings_pen_name(pens[at]);
        if (other && name && strcmp(other, name) == 0) break;
        at++;
    }
    if (at == WR_PENS_MAX) at--; /* in a full list the oldest is replaced */
    wr_free(pens[at]);
    pens[at] = kept;
}

/* ---- the settings file shared by all open windows ---- */

/* Each window merges its own changes into the file's content, so that none removes additions of another. */

#define FILE_NAME "window.conf"
#define LOCK_NAME "window.lock"
/* Tries of 1 ms for the final write; others hold the lock only for moments. */
#define PATIENCE_TRIES 5000

static void copy_texts(char **to, char *const *from, int most)
{
    for (int i = 0; i < most; i++) {
        wr_free(to[i]);
        to[i] = from[i] ? wr_strdup(from[i]) : NULL;
    }
}

/* Copy of the numbers alone; owns no texts. */
static WrSettings without_texts(const WrSettings *settings)
{
    WrSettings copy = *settings;
    TextRow rows[TEXT_ROWS];
    text_rows_of(&copy, rows);
    for (int i = 0; i < TEXT_ROWS; i++)
        memset(rows[i].texts, 0, (size_t)rows[i].most * sizeof *rows[i].texts);
    copy.brush.preset = NULL;
    copy.brush.tip = NULL;
    return copy;
}

static void copy_rows(WrSettings *settings, const WrSettings *from, bool shared_alone)
{
    WrSettings source = *from;
    TextRow to[TEXT_ROWS], have[TEXT_ROWS];
    text_rows_of(settings, to);
    text_rows_of(&source, have);
    for (int i = 0; i < TEXT_ROWS; i++)
        if (to[i].shared || !shared_alone) copy_texts(to[i].texts, have[i].texts, to[i].most);
}

void wr_settings_take_lists(WrSettings *settings, const WrSettings *from)
{
    copy_rows(settings, from, true);
}

WrSettings wr_settings_copy(const WrSettings *settings)
{
    WrSettings copy = without_texts(settings);
    copy_rows(&copy, settings, false);
    return copy;
}

static bool same_text(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

bool wr_settings_equal(const WrSettings *a, const WrSettings *b)
{
    WrText first = { 0 }, second = { 0 };
    wr_settings_print(a, &first);
    wr_settings_print(b, &second);
    bool equal = strcmp(wr_text_get(&first), wr_text_get(&second)) == 0;
    wr_text_fini(&first);
    wr_text_fini(&second);
    return equal;
}

/* ---- merge ---- */

/* Both print the same names in the same order, so differing lines are changes. */
static void merge_numbers(const WrSettings *base, const WrSettings *mine, WrSettings *theirs)
{
    WrSettings before = without_texts(base), now = without_texts(mine);
    WrText old = { 0 }, fresh = { 0 }, changed = { 0 };
    wr_settings_print(&before, &old);
    wr_settings_print(&now, &fresh);
    const char *a = wr_text_get(&old), *b = wr_text_get(&fresh);
    while (*a && *b) {
        size_t first = strcspn(a, "\n") + 1, second = strcspn(b, "\n") + 1;
        if (first != second || memcmp(a, b, first) != 0) wr_text_add_n(&changed, b, second);
        a += first;
        b += second;
    }
    wr_settings_parse(theirs, wr_text_get(&changed));
    wr_text_fini(&old);
    wr_text_fini(&fresh);
    wr_text_fini(&changed);
}

static int count_of(char *const *list, int most)
{
    int count = 0;
    while (count < most && list[count]) count++;
    return count;
}

static int place_of(char *const *list, int most, const char *text)
{
    for (int i = 0; i < most && list[i]; i++)
        if (strcmp(list[i], text) == 0) return i;
    return -1;
}

/* Number of entries at the front of `mine` that were added or moved there since `base`: those that the order of the
   remaining ones does not explain. */
static int fresh_of(char *const *base, char *const *mine, int most)
{
    int fresh = count_of(mine, most), behind = most;
    while (fresh > 0) {
        int at = place_of(base, most, mine[fresh - 1]);
        if (at < 0 || at >= behind) break;
        behind = at;
        fresh--;
    }
    return fresh;
}

static void merge_newest(char *const *base, char *const *mine, int most, WrSettings *theirs,
                         void (*note)(WrSettings *, const char *))
{
    for (int i = fresh_of(base, mine, most) - 1; i >= 0; i--) note(theirs, mine[i]);
}

static void merge_favourites(const WrSettings *base, const WrSettings *mine, WrSettings *theirs)
{
    for (int i = 0; i < WR_FAVOURITES_MAX && base->favourites[i]; i++)
        if (wr_settings_find_favourite(mine, base->favourites[i]) < 0)
            wr_settings_set_favourite(theirs, base->favourites[i], false);
    for (int i = 0; i < WR_FAVOURITES_MAX && mine->favourites[i]; i++)
        if (wr_settings_find_favourite(base, mine->favourites[i]) < 0)
            wr_settings_set_favourite(theirs, mine->favourites[i], true);
}

static void merge_pens(const WrSettings *base, const WrSettings *mine, WrSettings *theirs)
{
    for (int i = 0; i < WR_PENS_MAX && mine->pens[i]; i++)
        if (place_of(base->pens, WR_PENS_MAX, mine->pens[i]) < 0)
            wr_settings_keep_pen(theirs, mine->pens[i]);
}

static bool same_texts(const TextRow *a, const TextRow *b)
{
    for (int i = 0; i < a->most; i++)
        if (!same_text(a->texts[i], b->texts[i])) return false;
    return true;
}

/* Three-way merge: apply the changes from `base` to `mine` to `theirs`. */
static void settings_merge(const WrSettings *base, const WrSettings *mine, WrSettings *theirs)
{
    WrSettings before = *base, now = *mine;
    TextRow old[TEXT_ROWS], own[TEXT_ROWS], out[TEXT_ROWS];
    text_rows_of(&before, old);
    text_rows_of(&now, own);
    text_rows_of(theirs, out);
    merge_numbers(base, mine, theirs);
    for (int i = 0; i < TEXT_ROWS; i++) {
        if (own[i].note) merge_newest(old[i].texts, own[i].texts, own[i].most, theirs, own[i].note);
        else if (!own[i].shared && !same_texts(&old[i], &own[i]))
            copy_texts(out[i].texts, own[i].texts, own[i].most);
    }
    merge_favourites(base, mine, theirs);
    merge_pens(base, mine, theirs);
}

/* ---- the file ---- */

/* Lock for reading and writing the file; -1: another window holds it. */
static int lock(bool now)
{
    char *path = wr_config_path(LOCK_NAME);
    const unsigned how = WR_OPEN_READ | WR_OPEN_WRITE | WR_OPEN_CREATE | WR_OPEN_PRIVATE |
                         WR_OPEN_NO_LINK | WR_OPEN_NO_WAIT;
    int fd = path ? wr_fd_open(path, how) : -1;
    wr_free(path);
    for (int i = 0; fd >= 0; i++) {
        if (wr_fd_lock(fd, WR_LOCK_ALONE)) return fd;
        if (!now || i >= PATIENCE_TRIES) break;
        wr_thread_sleep_ms(1);
    }
    if (fd >= 0) wr_fd_close(fd);
    return -1;
}

/* Settings of the file; missing values, or all of them without a file, are those of `now`. */
static WrSettings read_file(const char *path, const WrSettings *now)
{
    char *bytes = NULL;
    size_t length = 0;
    bool good = wr_file_read(path, WR_SETTINGS_FILE_MAX, &bytes, &length, NULL) && length > 0;
    WrSettings theirs = good ? without_texts(now) : wr_settings_copy(now);
    if (good) wr_settings_parse(&theirs, bytes);
    wr_free(bytes);
    return theirs;
}

bool wr_settings_update(WrSettings *known, const WrSettings *now, bool last)
{
    char *path = wr_config_path(FILE_NAME);
    if (!path) return true; /* there is no settings folder */
    wr_settings_make_folder();
    int held = lock(last);
    bool good = held >= 0 || last;
    if (good) {
        WrSettings merged = read_file(path, now);
        WrText text = { 0 };
        settings_merge(known, now, &merged);
        wr_settings_print(&merged, &text);
        good = wr_file_write(path, wr_text_get(&text), text.length, NULL);
        if (good) {
            wr_settings_fini(known);
            *known = wr_settings_copy(now);
            wr_settings_take_lists(known, &merged);
        }
        wr_settings_fini(&merged);
        wr_text_fini(&text);
    }
    if (held >= 0) wr_fd_close(held);
    wr_free(path);
    return good;
}
