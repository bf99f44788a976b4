/* Writing of a set of maps. */
#include "export/map_sets.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "export/contact_sheet.h"
#include "export/export.h"
#include "export/picture.h"
#include "system/path.h"

#include <errno.h>
#include <string.h>

#define CONTACT "contact="

/* ---- options ---- */

static bool has_option(const WrExportKind *kind, const char *word, size_t length)
{
    for (const WrExportOptionInfo *o = kind->options; o->name; o++)
        if (strlen(o->name) == length && strncmp(o->name, word, length) == 0) return true;
    return false;
}

/* Sets an option if the kind has it (`taken`); false and a message only if the value is invalid. */
static bool set_word(const WrExportKind *kind, WrExportOptions *options, const char *word,
                     bool *taken, WrError *err)
{
    const char *equals = strchr(word, '=');
    char name[32];
    if (!equals) return wr_fail(err, "%.60s: must be name=value", word);
    size_t length = (size_t)(equals - word);
    if (length >= sizeof name || !has_option(kind, word, length)) return true;
    memcpy(name, word, length);
    name[length] = 0;
    *taken = true;
    return wr_export_option(kind, options, name, equals + 1, err);
}

/* Applies the set's settings, then the user's, which have priority. taken: [word_count]. */
static bool settle_map(const WrSetOrder *order, const WrSetMap *map, WrExportOptions *options,
                       bool *taken, WrError *err)
{
    bool own;
    *options = wr_export_default();
    for (int i = 0; i < WR_SET_SETTINGS && map->settings[i]; i++)
        if (!set_word(map->kind, options, map->settings[i], &own, err)) return false;
    for (int i = 0; i < order->word_count; i++)
        if (!set_word(map->kind, options, order->words[i], &taken[i], err)) return false;
    return true;
}

bool wr_set_options(const WrSetOrder *order, int map, WrExportOptions *options, WrError *err)
{
    bool taken[WR_SET_WORDS];
    return settle_map(order, &order->set->maps.data[map], options, taken, err);
}

/* The contact sheet requested by the words; NULL: none. */
static const char *contact_of(const WrSetOrder *order)
{
    for (int i = 0; i < order->word_count; i++)
        if (strncmp(order->words[i], CONTACT, sizeof CONTACT - 1) == 0)
            return order->words[i] + sizeof CONTACT - 1;
    return NULL;
}

static bool settle(const WrSetOrder *order, WrExportOptions options[WR_SET_MAPS], WrError *err)
{
    bool taken[WR_SET_WORDS] = { false };
    const char *contact = contact_of(order);
    if (contact && (!*contact || *contact == '.' || strchr(contact, '/')))
        return wr_fail(
            err, CONTACT "%.80s: must be a picture's name, such as contact.png, without a folder",
            contact);
    if (order->word_count > WR_SET_WORDS)
        return wr_fail(err, "%d options: a set takes up to %d", order->word_count, WR_SET_WORDS);
    for (int i = 0; i < order->set->maps.count; i++)
        if (!settle_map(order, &order->set->maps.data[i], &options[i], taken, err)) return false;
    for (int i = 0; i < order->word_count; i++)
        if (!taken[i] && strncmp(order->words[i], CONTACT, sizeof CONTACT - 1) != 0)
            return wr_fail(err, "%.60s: no map of the set %s has such an option", order->words[i],
                           order->set->name);
    return true;
}

/* ---- files ---- */

void wr_set_file(const WrSetOrder *order, int map, WrText *path)
{
    const WrSetMap *row = &order->set->maps.data[map];
    const size_t length = strlen(order->folder);
    const bool slash = length > 0 && order->folder[length - 1] == '/';
    wr_text_addf(path, "%s%s%s%s%s", order->folder, slash ? "" : "/", row->before, order->name,
                 row->after);
}

static bool check_names(const WrSetOrder *order, WrError *err)
{
    bool plain = *order->name != '\0';
    for (const char *c = order->name; *c; c++)
        plain = plain && *c != '/' && (unsigned char)*c >= ' ' && *c != 0x7f;
    if (!plain)
        return wr_fail(err, "name '%.60s': must be the cell's name in the files', without a folder",
                       order->name);
    if (!wr_path_is_folder(order->folder))
        return wr_fail(err, "%.200s: is no folder: a set is written into one that is there",
                       order->folder);
    if (!wr_path_can_write(order->folder) || !wr_path_can_run(order->folder))
        return wr_fail(err, "%.200s: files cannot be written there (%s)", order->folder,
                       strerror(errno));
    return true;
}

static bool write_map(const WrSetOrder *order, int map, const WrExportOptions *options,
                      const WrDocument *document, WrPool *pool, WrText *told, WrError *err)
{
    WrText path = { 0 };
    WrExportReport report;
    wr_set_file(order, map, &path);
    bool good = wr_export(order->set->maps.data[map].kind, document, options, pool,
                          wr_text_get(&path), &report, err);
    if (good) {
        wr_text_addf(told, "%s: ", wr_text_get(&path));
        wr_export_report_text(&report, told);
        wr_text_add(told, "\n");
    }
    wr_text_fini(&path);
    return good;
}

static bool write_maps(const WrSetOrder *order, const WrExportOptions *options,
                       const WrDocument *document, WrPool *pool, WrText *told, WrError *err)
{
    const int count = order->set->maps.count;
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        WrProgressPart share;
        const WrProgress *whole = wr_progress_enter(&share, (double)i / count, (i + 1.0) / count);
        good = write_map(order, i, &options[i], document, pool, told, err);
        wr_progress_set(whole);
    }
    return good && (!wr_progress_stopped() || wr_fail(err, "cancelled"));
}

/* ---- the contact sheet ---- */

/* Indices of the maps that are pictures of the table, into `shown`; returns their number. */
static int shown_of(const WrSet *set, int shown[WR_SET_MAPS])
{
    int count = 0;
    for (int i = 0; i < set->maps.count; i++)
        if (!set->maps.data[i].kind->write) shown[count++] = i;
    return count;
}

static bool add_map(WrContact *contact, const WrSetOrder *order, int map,
                    const WrExportOptions *options, const WrDocument *document, WrPool *pool,
                    WrError *err)
{
    const WrSetMap *row = &order->set->maps.data[map];
    WrText name = { 0 };
    WrExportPicture picture;
    const bool good = wr_export_picture(row->kind, document, options, pool, &picture, err);
    wr_text_addf(&name, "%s%s%s", row->before, order->name, row->after);
    if (good) wr_contact_add(contact, wr_text_get(&name), &picture);
    wr_export_picture_fini(&picture);
    wr_text_fini(&name);
    return good;
}

static bool is_map(const WrSetOrder *order, const char *name)
{
    WrText own = { 0 };
    bool same = false;
    for (int i = 0; i < order->set->maps.count && !same; i++) {
        const WrSetMap *row = &order->set->maps.data[i];
        wr_text_clear(&own);
        wr_text_addf(&own, "%s%s%s", row->before, order->name, row->after);
        same = strcmp(wr_text_get(&own), name) == 0;
    }
    wr_text_fini(&own);
    return same;
}

static bool write_contact(const WrSetOrder *order, const WrExportOptions *options,
                          const WrDocument *document, WrPool *pool, WrText *told, WrError *err)
{
    int shown[WR_SET_MAPS];
    const int count = shown_of(order->set, shown);
    if (count == 0)
        return wr_fail(err, CONTACT "%.80s: no map of the set %s is a picture of the table",
                       contact_of(order), order->set->name);
    if (is_map(order, contact_of(order)))
        return wr_fail(err, CONTACT "%.80s: is the name of one of the maps", contact_of(order));
    char *path = wr_path_join(order->folder, contact_of(order));
    WrContact *contact = wr_contact_new(path, count, WR_CONTACT_TILE, err);
    bool good = contact != NULL;
    for (int i = 0; i < count && good; i++)
        good = add_map(contact, order, shown[i], &options[shown[i]], document, pool, err) &&
               (!wr_progress_stopped() || wr_fail(err, "cancelled"));
    good = good && wr_contact_write(contact, err);
    if (good) wr_text_addf(told, "%s: contact sheet of %d maps\n", path, count);
    wr_contact_free(contact);
    wr_free(path);
    return good;
}

bool wr_export_set(const WrSetOrder *order, const WrDocument *document, WrPool *pool, WrText *told,
                   WrError *err)
{
    WrExportOptions options[WR_SET_MAPS];
    const size_t before = told->length;
    if (!check_names(order, err) || !settle(order, options, err)) return false;
    WrFileGroup *group = wr_file_group_begin();
    bool good = write_maps(order, options, document, pool, told, err) &&
                (!contact_of(order) || write_contact(order, options, document, pool, told, err));
    if (good) good = wr_file_group_commit(group, err);
    else wr_file_group_abort(group);
    if (!good && told->length > before) { /* nothing was written */
        told->length = before;
        told->data[before] = '\0';
    }
    return good;
}

void wr_set_cell_name(const char *path, WrText *name)
{
    const char *file = path && *path ? path : "wrinkle", *slash = strrchr(file, '/');
    const char *base = slash ? slash + 1 : file, *dot = strrchr(base, '.');
    wr_text_add_n(name, base, dot && dot > base ? (size_t)(dot - base) : strlen(base));
}
