/* The settings file shared by all open windows. Each window merges its own changes into the file's content, so that
   none removes additions of another. */
#include "ui/state/settings.h"

#include "base/array.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/fd.h"
#include "system/thread.h"

#include <string.h>
#include <time.h>

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
    memset(copy.recent, 0, sizeof copy.recent);
    memset(copy.pens, 0, sizeof copy.pens);
    memset(copy.favourites, 0, sizeof copy.favourites);
    memset(copy.used, 0, sizeof copy.used);
    memset(copy.fonts, 0, sizeof copy.fonts);
    copy.preset = copy.tip = copy.set = NULL;
    copy.brush.preset = NULL;
    copy.brush.tip = NULL;
    return copy;
}

void wr_settings_take_lists(WrSettings *settings, const WrSettings *from)
{
    copy_texts(settings->recent, from->recent, WR_RECENT_MAX);
    copy_texts(settings->pens, from->pens, WR_PENS_MAX);
    copy_texts(settings->favourites, from->favourites, WR_FAVOURITES_MAX);
    copy_texts(settings->used, from->used, WR_USED_MAX);
    copy_texts(settings->fonts, from->fonts, WR_FONTS_MAX);
}

WrSettings wr_settings_copy(const WrSettings *settings)
{
    WrSettings copy = without_texts(settings);
    wr_settings_take_lists(&copy, settings);
    wr_settings_set_text(&copy.preset, settings->preset);
    wr_settings_set_text(&copy.tip, settings->tip);
    wr_settings_set_text(&copy.set, settings->set);
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

static void merge_text(const char *base, const char *mine, char **theirs)
{
    if (!same_text(base, mine)) wr_settings_set_text(theirs, mine);
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
        if (wr_settings_favourite(mine, base->favourites[i]) < 0)
            wr_settings_set_favourite(theirs, base->favourites[i], false);
    for (int i = 0; i < WR_FAVOURITES_MAX && mine->favourites[i]; i++)
        if (wr_settings_favourite(base, mine->favourites[i]) < 0)
            wr_settings_set_favourite(theirs, mine->favourites[i], true);
}

static void merge_pens(const WrSettings *base, const WrSettings *mine, WrSettings *theirs)
{
    for (int i = 0; i < WR_PENS_MAX && mine->pens[i]; i++)
        if (place_of(base->pens, WR_PENS_MAX, mine->pens[i]) < 0)
            wr_settings_keep_pen(theirs, mine->pens[i]);
}

void wr_settings_merge(const WrSettings *base, const WrSettings *mine, WrSettings *theirs)
{
    merge_numbers(base, mine, theirs);
    merge_text(base->preset, mine->preset, &theirs->preset);
    merge_text(base->tip, mine->tip, &theirs->tip);
    merge_text(base->set, mine->set, &theirs->set);
    merge_newest(base->recent, mine->recent, WR_RECENT_MAX, theirs, wr_settings_note_recent);
    merge_newest(base->used, mine->used, WR_USED_MAX, theirs, wr_settings_note_used);
    merge_newest(base->fonts, mine->fonts, WR_FONTS_MAX, theirs, wr_settings_note_font);
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
        wr_settings_merge(known, now, &merged);
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
