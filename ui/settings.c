/* SPDX-License-Identifier: MIT */
#include "ui/settings.h"

#include "base/file.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

WrSettings wr_settings_default(void)
{
    return (WrSettings){ .width = 1440,
                         .height = 900,
                         .divider = 0.5,
                         .panels = true,
                         .lower = 0.42,
                         .ants = true,
                         .turning = true,
                         .brush = { .radius = 16, .hardness = 0.5, .strength = 0.1 },
                         .look = { .high = 1.0 } };
}

void wr_settings_fini(WrSettings *settings)
{
    for (int i = 0; i < WR_RECENT_MAX; i++) wr_free(settings->recent[i]);
    *settings = (WrSettings){ 0 };
}

/* ---- lines ---- */

/* A setting that is a number: where it is kept and what is allowed. */
typedef struct Row {
    const char *name;
    double *real; /* one of real, whole, flag */
    int *whole;
    bool *flag;
    double low, high;
} Row;

#define ROWS_MAX 24

static int rows_of(WrSettings *s, Row rows[ROWS_MAX])
{
    const Row all[] = {
        { "width", NULL, &s->width, NULL, 320, 32768 },
        { "height", NULL, &s->height, NULL, 240, 32768 },
        { "maximized", NULL, NULL, &s->maximized, 0, 1 },
        { "scale", &s->scale, NULL, NULL, 0, 3 },
        { "divider", &s->divider, NULL, NULL, 0.05, 0.95 },
        { "views", NULL, (int *)&s->views, NULL, 0, 2 },
        { "panels", NULL, NULL, &s->panels, 0, 1 },
        { "lower", &s->lower, NULL, NULL, 0.05, 0.95 },
        { "ants", NULL, NULL, &s->ants, 0, 1 },
        { "join", NULL, &s->join, NULL, 0, 3 },
        { "tab", NULL, &s->tab, NULL, 0, 15 },
        { "turning", NULL, NULL, &s->turning, 0, 1 },
        { "radius", &s->brush.radius, NULL, NULL, 0, 1e9 },
        { "hardness", &s->brush.hardness, NULL, NULL, 0, 1 },
        { "strength", &s->brush.strength, NULL, NULL, -1e30, 1e30 },
        { "mode", NULL, (int *)&s->brush.mode, NULL, 0, WR_BRUSH_MODE_COUNT - 1 },
        { "to", &s->brush.to, NULL, NULL, -1e30, 1e30 },
        { "colours", NULL, (int *)&s->look.colours, NULL, 0, WR_CANVAS_COLOURS - 1 },
        { "automatic", NULL, NULL, &s->look.automatic, 0, 1 },
        { "low", &s->look.low, NULL, NULL, -1e30, 1e30 },
        { "high", &s->look.high, NULL, NULL, -1e30, 1e30 },
    };
    int count = (int)(sizeof all / sizeof *all);
    memcpy(rows, all, sizeof all);
    return count;
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

static void add_recent_last(WrSettings *settings, const char *path, size_t length)
{
    for (int i = 0; i < WR_RECENT_MAX; i++) {
        if (settings->recent[i]) continue;
        if (length > 0) settings->recent[i] = wr_strndup(path, length);
        return;
    }
}

void wr_settings_parse(WrSettings *settings, const char *text)
{
    for (const char *at = text; *at;) {
        size_t length = strcspn(at, "\n"), name = strcspn(at, " \n");
        if (name < length) {
            const char *value = at + name + 1;
            if (name == 6 && strncmp(at, "recent", 6) == 0)
                add_recent_last(settings, value, length - name - 1);
            else take(settings, at, name, value, length - name - 1);
        }
        at += length + (at[length] == '\n');
    }
    if (!(settings->look.low < settings->look.high)) {
        settings->look.low = 0.0;
        settings->look.high = 1.0;
    }
}

void wr_settings_print(const WrSettings *settings, WrText *text)
{
    WrSettings copy = *settings; /* rows point into a struct that they could change */
    Row rows[ROWS_MAX];
    int count = rows_of(&copy, rows);
    for (int i = 0; i < count; i++) {
        wr_text_addf(text, "%s ", rows[i].name);
        wr_text_add_number(text, rows[i].real    ? *rows[i].real
                                 : rows[i].whole ? *rows[i].whole
                                                 : *rows[i].flag);
        wr_text_add(text, "\n");
    }
    for (int i = 0; i < WR_RECENT_MAX && settings->recent[i]; i++)
        if (!strchr(settings->recent[i], '\n'))
            wr_text_addf(text, "recent %s\n", settings->recent[i]);
}

/* ---- files ---- */

static char *config_folder(void)
{
    const char *xdg = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    if (xdg && xdg[0] == '/') return wr_path_join(xdg, "wrinkle");
    if (!home || home[0] != '/') return NULL;
    char *config = wr_path_join(home, ".config");
    char *folder = wr_path_join(config, "wrinkle");
    wr_free(config);
    return folder;
}

char *wr_config_path(const char *name)
{
    char *folder = config_folder();
    if (!folder) return NULL;
    char *path = wr_path_join(folder, name);
    wr_free(folder);
    return path;
}

void wr_settings_load(WrSettings *settings)
{
    char *path = wr_config_path("window.conf"), *bytes = NULL;
    size_t length;
    if (path && wr_file_read(path, 1 << 16, &bytes, &length, NULL))
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
        mkdir(copy, 0700);
        *c = '/';
    }
    mkdir(copy, 0700);
    wr_free(copy);
}

void wr_settings_save(const WrSettings *settings)
{
    char *folder = config_folder(), *path = wr_config_path("window.conf");
    if (folder && path) {
        WrText text = { 0 };
        make_folders(folder);
        wr_settings_print(settings, &text);
        wr_file_write(path, wr_text_get(&text), text.length, NULL);
        wr_text_fini(&text);
    }
    wr_free(folder);
    wr_free(path);
}

void wr_settings_note_recent(WrSettings *settings, const char *path)
{
    char *first = wr_strdup(path);
    int at = 0;
    while (at < WR_RECENT_MAX - 1 && settings->recent[at] &&
           strcmp(settings->recent[at], path) != 0)
        at++;
    wr_free(settings->recent[at]);
    memmove(settings->recent + 1, settings->recent, (size_t)at * sizeof *settings->recent);
    settings->recent[0] = first;
}
