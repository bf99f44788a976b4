/* The installed fonts, as listed by fontconfig. */
#include "image/font_list.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/font.h"
#include "image/font_list.h"
#include "system/child.h"
#include "system/path.h"

#include <fontconfig/fontconfig.h>
#include <stdlib.h>
#include <string.h>

#define MAX_NAME 80 /* bytes */
#define MAX_PATH 4000
#define LETTERS 8 /* letters of a sample that is not the font's name */

typedef struct Listed {
    WrFontEntry face;
    double weight, width;
    int slant;
} Listed;
typedef WR_ARRAY(Listed) List;

/* ---- properties of a font ---- */

/* A name of one line, cut at a character boundary; NULL if it has no readable name. Caller frees. */
static char *name_of(FcPattern *font, const char *what)
{
    FcChar8 *said = NULL;
    if (FcPatternGetString(font, what, 0, &said) != FcResultMatch || !said[0]) return NULL;
    size_t length = 0;
    while (length < MAX_NAME && said[length]) length++;
    while (length > 0 && (said[length] & 0xc0) == 0x80) length--;
    char *name = wr_strndup((const char *)said, length);
    for (char *c = name; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f) *c = ' ';
    if (name[strspn(name, " ")] && wr_font_strange_bytes(name) == 0) return name;
    wr_free(name);
    return NULL;
}

static void add_letter(WrText *text, FcChar32 c)
{
    FcChar8 bytes[FC_UTF8_MAX_LEN];
    const int length = FcUcs4ToUtf8(c, bytes);
    if (length > 0) wr_text_add_n(text, (const char *)bytes, (size_t)length);
}

static bool has_all(const FcCharSet *has, const char *name)
{
    FcChar32 c;
    int taken;
    for (const FcChar8 *at = (const FcChar8 *)name; *at; at += taken) {
        taken = FcUtf8ToUcs4(at, &c, (int)strlen((const char *)at));
        if (taken <= 0 || (c != ' ' && !FcCharSetHasChar(has, c))) return false;
    }
    return true;
}

/* True for a characteristic letter: no combining mark, and not one that almost every font has. */
static bool tells(FcChar32 c)
{
    return c >= 0x250 && !(c >= 0x300 && c < 0x370) && !(c >= 0x483 && c < 0x48a) &&
           !(c >= 0x591 && c < 0x5d0) && !(c >= 0x600 && c < 0x621) && !(c >= 0x64b && c < 0x66e) &&
           !(c >= 0x900 && c < 0x905) && !(c >= 0x93a && c < 0x958) &&
           !(c >= 0x2000 && c < 0x2190) && c != 0x25cc && !(c >= 0xe000 && c < 0xf900) &&
           !(c >= 0xfb1d && c < 0xfb20) && !(c >= 0xfe00 && c < 0xfe30) && c < 0xe0000;
}

static void some_letters(const FcCharSet *has, bool telling, WrText *text)
{
    FcChar32 map[FC_CHARSET_MAP_SIZE], next;
    int count = 0;
    for (FcChar32 base = FcCharSetFirstPage(has, map, &next);
         base != FC_CHARSET_DONE && count < LETTERS; base = FcCharSetNextPage(has, map, &next))
        for (FcChar32 i = 0; i < FC_CHARSET_MAP_SIZE * 32 && count < LETTERS; i++) {
            FcChar32 c = base + i;
            if (!(map[i / 32] >> (i % 32) & 1) || c <= 0x20 || (c >= 0x7f && c <= 0xa0)) continue;
            if (telling && !tells(c)) continue;
            add_letter(text, c);
            count++;
        }
}

/* Caller frees. */
static char *sample_of(FcPattern *font, const char *name)
{
    FcCharSet *has = NULL;
    WrText text = { 0 };
    if (FcPatternGetCharSet(font, FC_CHARSET, 0, &has) != FcResultMatch || has_all(has, name))
        return wr_strdup(name);
    some_letters(has, true, &text);
    if (text.length == 0) some_letters(has, false, &text);
    char *sample = wr_strdup(text.length > 0 ? wr_text_get(&text) : name);
    wr_text_fini(&text);
    return sample;
}

/* ---- the list ---- */

static FcBool flag(FcPattern *font, const char *what)
{
    FcBool value = FcFalse;
    FcPatternGetBool(font, what, 0, &value);
    return value;
}

/* A number, or the middle of a variable font's range. */
static double measure(FcPattern *font, const char *what, double fallback)
{
    double value = fallback, end = fallback;
    FcRange *range = NULL;
    if (FcPatternGetDouble(font, what, 0, &value) == FcResultMatch) return value;
    if (FcPatternGetRange(font, what, 0, &range) == FcResultMatch &&
        FcRangeGetDouble(range, &value, &end))
        return fallback >= value && fallback <= end ? fallback : value;
    return fallback;
}

/* True if the path can be written in a command line. */
static bool can_be_named(const char *path)
{
    for (const char *c = path; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f) return false;
    return strlen(path) < MAX_PATH && wr_font_strange_bytes(path) == 0;
}

static void take(List *list, FcPattern *font)
{
    FcChar8 *file = NULL;
    WrFileInfo info;
    int index = 0, slant = FC_SLANT_ROMAN;
    if (FcPatternGetString(font, FC_FILE, 0, &file) != FcResultMatch) return;
    FcPatternGetInteger(font, FC_INDEX, 0, &index);
    FcPatternGetInteger(font, FC_SLANT, 0, &slant);
    if (!flag(font, FC_OUTLINE) || flag(font, FC_COLOR)) return;
    if (index >> 16) return; /* a named instance of a variable font */
    if (!wr_path_info((const char *)file, &info) || info.bytes > WR_FONT_FILE_MAX) return;
    if (!can_be_named((const char *)file)) return;
    char *family = name_of(font, FC_FAMILY), *style = name_of(font, FC_STYLE);
    if (!family) {
        const char *slash = strrchr((const char *)file, '/');
        const char *last = slash ? slash + 1 : (const char *)file;
        family = wr_strdup(last);
    }
    Listed one = { .face = { .family = family,
                             .style = style ? style : wr_strdup(""),
                             .path = wr_strdup((const char *)file),
                             .sample = sample_of(font, family),
                             .face = index & 0xffff },
                   .weight = measure(font, FC_WEIGHT, FC_WEIGHT_REGULAR),
                   .width = measure(font, FC_WIDTH, FC_WIDTH_NORMAL),
                   .slant = slant };
    wr_array_push(list, one);
}

static int letter(char c)
{
    return c >= 'A' && c <= 'Z' ? c + 32 : (unsigned char)c;
}

/* Compares without case. */
static int by_name(const char *a, const char *b)
{
    while (*a && letter(*a) == letter(*b)) a++, b++;
    return letter(*a) - letter(*b);
}

/* Type 1 outlines are often installed beside the same font as OpenType, which has more letters. */
static bool is_type1(const char *path)
{
    char ending[16];
    wr_path_ending(path, ending);
    return strcmp(ending, "t1") == 0 || strcmp(ending, "pfb") == 0 || strcmp(ending, "pfa") == 0;
}

static int compare(const void *a, const void *b)
{
    const Listed *x = a, *y = b;
    int way = by_name(x->face.family, y->face.family);
    if (way == 0) way = strcmp(x->face.family, y->face.family);
    if (way == 0) way = (x->width > y->width) - (x->width < y->width);
    if (way == 0) way = (x->weight > y->weight) - (x->weight < y->weight);
    if (way == 0) way = (x->slant > y->slant) - (x->slant < y->slant);
    if (way == 0) way = strcmp(x->face.style, y->face.style);
    if (way == 0) way = is_type1(x->face.path) - is_type1(y->face.path);
    if (way == 0) way = strcmp(x->face.path, y->face.path);
    return way ? way : x->face.face - y->face.face;
}

static FcFontSet *listed(FcConfig *config)
{
    FcPattern *any = FcPatternCreate();
    FcObjectSet *wanted =
        FcObjectSetBuild(FC_FAMILY, FC_STYLE, FC_FILE, FC_INDEX, FC_WEIGHT, FC_WIDTH, FC_SLANT,
                         FC_OUTLINE, FC_COLOR, FC_CHARSET, (char *)NULL);
    FcFontSet *set = any && wanted ? FcFontList(config, any, wanted) : NULL;
    if (any) FcPatternDestroy(any);
    if (wanted) FcObjectSetDestroy(wanted);
    return set;
}

void wr_font_entry_fini(WrFontEntry *entry)
{
    wr_free(entry->family);
    wr_free(entry->style);
    wr_free(entry->path);
    wr_free(entry->sample);
}

/* A variable font is listed several times, and a Type 1 font may duplicate an earlier one. */
static bool listed_before(const WrFontList *list, const WrFontEntry *entry)
{
    for (int i = list->count - 1; i >= 0; i--) {
        if (by_name(list->data[i].family, entry->family) != 0) return false;
        if (list->data[i].face == entry->face && strcmp(list->data[i].path, entry->path) == 0)
            return true;
        if (is_type1(entry->path) && strcmp(list->data[i].style, entry->style) == 0) return true;
    }
    return false;
}

bool wr_font_list(WrFontList *list, WrError *err)
{
    List found = { 0 };
    if (!wr_font_config(err)) return false;
    FcConfig *config = FcConfigReference(NULL);
    FcFontSet *set = config ? listed(config) : NULL;
    for (int i = 0; set && i < set->nfont; i++) take(&found, set->fonts[i]);
    if (found.count > 1) qsort(found.data, (size_t)found.count, sizeof *found.data, compare);
    for (int i = 0; i < found.count; i++)
        if (!listed_before(list, &found.data[i].face)) wr_array_push(list, found.data[i].face);
        else wr_font_entry_fini(&found.data[i].face);
    wr_array_free(&found);
    if (set) FcFontSetDestroy(set);
    if (config) FcConfigDestroy(config);
    return set || wr_fail(err, "fontconfig returned no list of fonts");
}

void wr_font_list_fini(WrFontList *list)
{
    for (int i = 0; i < list->count; i++) wr_font_entry_fini(&list->data[i]);
    wr_array_free(list);
}

/* ---- Fontconfig ---- */

#define SECONDS 120.0
#define BYTES ((uint64_t)2 << 30)
/* The address sanitizer's allocator has a lock that another thread may hold at the fork; the copy would wait for it. */
#ifdef __SANITIZE_ADDRESS__
#define TRIED_IN_COPY false
#else
#define TRIED_IN_COPY true
#endif

static void try_load(void *ctx, void *answer)
{
    (void)ctx;
    *(bool *)answer = FcInit();
}

static bool crashed(WrChildEnd end, WrError *err)
{
    const char *name = wr_child_crash(end.number);
    return wr_fail(err, "fontconfig crashes on one of the installed fonts (%s)",
                   end.why == WR_CHILD_LATE ? "it does not end"
                   : name                   ? name
                                            : "it ended");
}

/* The copy has cached its results in files, so only those are read here. */
static bool load(void *ctx, WrError *err)
{
    bool good = false;
    WrChildEnd end;
    const WrTry it = { .work = try_load,
                       .answer = &good,
                       .length = sizeof good,
                       .seconds = SECONDS,
                       .memory = BYTES,
                       .stopped = wr_progress_stopped };
    const WrTryResult result = TRIED_IN_COPY ? wr_child_try(&it, &end) : WR_TRY_NO_CHILD;
    (void)ctx;
    if (result == WR_TRY_ENDED) return crashed(end, err);
    if (result == WR_TRY_LATE) return wr_fail(err, "fontconfig: no list of fonts in %g s", SECONDS);
    if (result == WR_TRY_ANSWERED && !good) return wr_fail(err, "fontconfig does not work");
    return FcInit() ||
           wr_fail(err, "fontconfig does not work"); /* also if no copy can be started */
}

static WrOnceAsync loaded = { .work = load };

bool wr_font_config(WrError *err)
{
    return wr_once_async_wait(&loaded, err);
}

void wr_font_config_begin(void)
{
    wr_once_async_begin(&loaded);
}

bool wr_font_config_done(void)
{
    return wr_once_async_done(&loaded);
}

/* ---- files of families ---- */

/* The first readable file of an exact family and weight, in the order of their paths; NULL: none. Instances of variable fonts
   and further faces of a collection (index > 0) are left out: their files open as another face. */
static char *first_file(FcConfig *config, const char *family, int weight)
{
    char *found = NULL;
    FcObjectSet *members = FcObjectSetBuild(FC_FILE, FC_INDEX, (char *)NULL);
    FcPattern *pattern = FcPatternBuild(
        NULL, FC_FAMILY, FcTypeString, family, FC_WEIGHT, FcTypeInteger,
        FcWeightFromOpenType(weight), FC_SLANT, FcTypeInteger, FC_SLANT_ROMAN, FC_WIDTH,
        FcTypeInteger, FC_WIDTH_NORMAL, FC_VARIABLE, FcTypeBool, FcFalse, (char *)NULL);
    FcFontSet *set = members && pattern ? FcFontList(config, pattern, members) : NULL;
    for (int i = 0; set && i < set->nfont; i++) {
        FcChar8 *file = NULL;
        int index = 1;
        FcPatternGetInteger(set->fonts[i], FC_INDEX, 0, &index);
        if (index != 0 || FcPatternGetString(set->fonts[i], FC_FILE, 0, &file) != FcResultMatch ||
            (found && strcmp(found, (const char *)file) <= 0) ||
            !wr_path_can_read((const char *)file))
            continue;
        wr_free(found);
        found = wr_strdup((const char *)file);
    }
    if (set) FcFontSetDestroy(set);
    if (pattern) FcPatternDestroy(pattern);
    if (members) FcObjectSetDestroy(members);
    return found;
}

char *wr_font_file(const char *const *families, int weight)
{
    static const uint32_t letter = 'A';
    char *found = NULL;
    if (!wr_font_config(NULL)) return NULL;
    FcConfig *config = FcConfigReference(NULL);
    for (; config && *families && !found; families++)
        if (strcmp(*families, "sans-serif") != 0) found = first_file(config, *families, weight);
        else wr_font_lenders(&letter, 1, weight >= 600 ? "sans-bold" : "sans", NULL, 1, &found);
    if (config) FcConfigDestroy(config);
    return found;
}
