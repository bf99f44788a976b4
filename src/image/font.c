/* Requests of shaped texts to the reader process, and fonts by name. */
#include "image/font.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/font_list.h"
#include "image/font_internal.h"
#include "image/reader_client.h"
#include "system/fd.h"
#include "system/path.h"

#include <errno.h>
#include <fontconfig/fontconfig.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- names ---- */

const char *const wr_font_names[] = { WR_FONT_FAMILIES(WR_WORD) NULL };

typedef struct Named {
    const char *family; /* as fontconfig lists it */
    int weight;         /* of OpenType */
    const char *package;
    bool strikes; /* a bitmap font, with a file for each size */
} Named;

WR_ROWS(named);
static const Named named[] = {
    [WR_ROW(WR_FONT_TERMINUS)] = { "Terminus", 400, "xfonts-terminus", true },
    [WR_ROW(WR_FONT_TERMINUS_BOLD)] = { "Terminus", 700, "xfonts-terminus", true },
    [WR_ROW(WR_FONT_SANS)] = { "DejaVu Sans", 400, "fonts-dejavu-core", false },
    [WR_ROW(WR_FONT_SANS_BOLD)] = { "DejaVu Sans", 700, "fonts-dejavu-core", false },
    [WR_ROW(WR_FONT_SERIF)] = { "DejaVu Serif", 400, "fonts-dejavu-core", false },
    [WR_ROW(WR_FONT_SERIF_BOLD)] = { "DejaVu Serif", 700, "fonts-dejavu-core", false },
    [WR_ROW(WR_FONT_MONO)] = { "DejaVu Sans Mono", 400, "fonts-dejavu-core", false },
    [WR_ROW(WR_FONT_MONO_BOLD)] = { "DejaVu Sans Mono", 700, "fonts-dejavu-core", false },
    [WR_ROW(WR_FONT_INTER)] = { "Inter", 400, "fonts-inter", false },
    [WR_ROW(WR_FONT_INTER_BOLD)] = { "Inter", 700, "fonts-inter", false },
};
WR_ROWS_END(named, WR_FONT_FAMILY_COUNT);

/* A file in one of fontconfig's folders. Its lists lack bitmap fonts where its rules refuse them, as Debian's do. */
static char *file_in_folders(const char *name)
{
    char *found = NULL;
    if (!wr_font_config(NULL)) return NULL;
    FcStrList *folders = FcConfigGetFontDirs(NULL);
    for (FcChar8 *folder; folders && !found && (folder = FcStrListNext(folders));) {
        char *path = wr_path_join((const char *)folder, name);
        if (wr_path_can_read(path)) found = path;
        else wr_free(path);
    }
    if (folders) FcStrListDone(folders);
    return found;
}

/* Bitmap fonts scale by whole numbers only: the largest strike that divides the size, else the largest below it. */
static int terminus_dots(double size)
{
    static const int dots[] = { 32, 28, 24, 22, 20, 18, 16, 14, 12 };
    int smaller = 0;
    for (size_t i = 0; i < sizeof dots / sizeof *dots; i++) {
        double times = size / dots[i];
        if (times >= 1.0 && times == (double)(int64_t)times) return dots[i];
        if (!smaller && times >= 1.0) smaller = dots[i];
    }
    return smaller ? smaller : 12;
}

/* Debian adds "_unicode" to the names of the font's own build. */
static char *terminus_file(double size, bool bold)
{
    static const char *const tails[] = { "_unicode.pcf.gz", ".pcf.gz" };
    char *found = NULL;
    for (size_t i = 0; i < sizeof tails / sizeof *tails && !found; i++) {
        WrText name = { 0 };
        wr_text_addf(&name, "ter-u%d%c%s", terminus_dots(size), bold ? 'b' : 'n', tails[i]);
        found = file_in_folders(wr_text_get(&name));
        wr_text_fini(&name);
    }
    return found;
}

const char *wr_font_family(int index)
{
    return named[index].family;
}

char *wr_font_find(int index, double size, WrError *err)
{
    const Named *font = &named[index];
    char *found = font->strikes
                      ? terminus_file(size, font->weight > 400)
                      : wr_font_file((const char *const[]){ font->family, NULL }, font->weight);
    if (!found)
        wr_fail(err, "the font %s is not installed (%s): install the package %s",
                wr_font_names[index], font->family, font->package);
    return found;
}

/* ---- shaping ---- */

/* The font files; the first descriptor is borrowed. */
typedef struct Files {
    const char *name; /* name of the first file */
    int fd;           /* all files, concatenated */
    int count;
    uint64_t lengths[WR_FONT_FILES], total;
} Files;

static bool shape_inside(const Files *files, const WrFontRequest *ask, WrText *block, WrError *err)
{
    WrFontFile parts[WR_FONT_FILES];
    void *map = wr_map(files->fd, (size_t)files->total, WR_MAP_READ);
    if (!map) return wr_fail(err, "%s: %s", files->name, strerror(errno));
    const uint8_t *at = map;
    for (int i = 0; i < files->count; i++) {
        parts[i] = (WrFontFile){ at, (size_t)files->lengths[i] };
        at += files->lengths[i];
    }
    bool good = wr_font_shape_text(parts, files->count, ask, block, err);
    wr_map_end(map, (size_t)files->total);
    if (!good) wr_error_prefix(err, "%s: ", files->name);
    return good;
}

static bool shape_outside(const Files *files, const WrFontRequest *ask, WrText *block, WrError *err)
{
    const char *language = ask->language ? ask->language : "", *axes = ask->axes ? ask->axes : "";
    WrFontOrder order = { .face = ask->face,
                          .direction = (int32_t)ask->direction,
                          .text_length = (int32_t)strlen(ask->text),
                          .language_length = (int32_t)strlen(language),
                          .axes_length = (int32_t)strlen(axes),
                          .file_count = files->count };
    memcpy(order.lengths, files->lengths, sizeof order.lengths);
    WrText want = { 0 };
    wr_text_add_n(&want, (const char *)&order, sizeof order);
    wr_text_add_n(&want, ask->text, (size_t)order.text_length + 1);
    wr_text_add_n(&want, language, (size_t)order.language_length + 1);
    wr_text_add_n(&want, axes, (size_t)order.axes_length + 1);
    bool good = wr_reader_block(files->name, files->fd, WR_WIRE_FONT, want.data, want.length,
                                &block->data, &block->length, err);
    wr_text_fini(&want);
    return good;
}

/* Adds a file's length to the list. */
static bool take_file(Files *files, const char *name, int fd, WrError *err)
{
    WrFileInfo info;
    if (!wr_fd_info(fd, &info)) return wr_fail(err, "%s: %s", name, strerror(errno));
    if (info.bytes == 0) return wr_fail(err, "%s: is empty", name);
    if (info.bytes > WR_FONT_FILE_MAX)
        return wr_fail(err, "%s: has %.0f MB: fonts may have up to %d MB", name,
                       (double)info.bytes / 1048576.0, WR_FONT_FILE_MAX >> 20);
    files->lengths[files->count++] = (uint64_t)info.bytes;
    files->total += (uint64_t)info.bytes;
    return true;
}

static bool check_ask(const char *name, const WrFontRequest *ask, WrError *err)
{
    size_t length = strlen(ask->text);
    if (length > WR_FONT_TEXT_MAX)
        return wr_fail(err, "a text of %zu bytes: must be up to %d", length, WR_FONT_TEXT_MAX);
    if (ask->face < 0 || ask->face > 65535)
        return wr_fail(err, "%s: face %d: must be 0..65535", name, ask->face);
    if (ask->language && strlen(ask->language) > 64)
        return wr_fail(err, "a language of %zu letters: must be one as in \"ar\"",
                       strlen(ask->language));
    if (ask->axes && strlen(ask->axes) > 1024)
        return wr_fail(err, "axes of %zu letters: must be up to 1024", strlen(ask->axes));
    return true;
}

static bool append_file(Files *files, const char *name, int fd, WrError *err)
{
    if (!take_file(files, name, fd, err)) return false;
    size_t length = (size_t)files->lengths[files->count - 1];
    void *map = wr_map(fd, length, WR_MAP_READ);
    bool good = map && wr_fd_write(files->fd, map, length);
    wr_map_end(map, length);
    return good || wr_fail(err, "%s: not enough memory to read it", name);
}

/* Concatenates all files into one memory file. The reader process receives one descriptor: a single font is passed as it is,
   several are concatenated and described by their lengths. */
static bool gather(Files *files, int fd, const WrFontRequest *ask, WrError *err)
{
    files->fd = wr_fd_memory("wrinkle fonts");
    if (files->fd < 0) return wr_fail(err, "%s: not enough memory to read it", files->name);
    bool good = append_file(files, files->name, fd, err);
    for (int i = 0; good && i < WR_FONT_OTHERS && ask->others[i]; i++) {
        int other = wr_file_open(ask->others[i], WR_FONT_FILE_MAX, NULL, err);
        good = other >= 0 && append_file(files, ask->others[i], other, err);
        if (other >= 0) wr_fd_close(other);
    }
    if (!good) wr_fd_close(files->fd);
    return good;
}

static bool shape(const char *name, int fd, const WrFontRequest *ask, WrFontText *out, WrError *err)
{
    WrText block = { 0 };
    Files files = { .name = name, .fd = fd };
    bool several = ask->others[0] != NULL;
    if (!check_ask(name, ask, err)) return false;
    if (!(several ? gather(&files, fd, ask, err) : take_file(&files, name, fd, err))) return false;
    bool good = wr_reader_inside() ? shape_inside(&files, ask, &block, err)
                                   : shape_outside(&files, ask, &block, err);
    if (several) wr_fd_close(files.fd);
    if (!good) return false;
    if (wr_font_unpack(block.data, block.length, strlen(ask->text), out)) return true;
    wr_text_fini(&block);
    return wr_fail(err, "%s: its data is inconsistent; the font is damaged or hostile", name);
}

bool wr_font_shape(const char *path, const WrFontRequest *ask, WrFontText *out, WrError *err)
{
    int fd = wr_file_open(path, WR_FONT_FILE_MAX, NULL, err);
    if (fd < 0) return false;
    bool good = shape(path, fd, ask, out, err);
    wr_fd_close(fd);
    return good;
}

bool wr_font_shape_bytes(const char *name, const void *bytes, size_t length,
                         const WrFontRequest *ask, WrFontText *out, WrError *err)
{
    int fd = wr_fd_in_memory(name, bytes, length, err);
    if (fd < 0) return false;
    bool good = shape(name, fd, ask, out, err);
    wr_fd_close(fd);
    return good;
}

/* ---- fallback fonts ---- */

/* Search of installed fonts by their characters, with fontconfig. */

/* Outline fonts, those nearest to these letters first. NULL: fontconfig does not work. */
static FcFontSet *sorted(FcConfig *config, const FcCharSet *wanted, const char *kind,
                         const char *language)
{
    FcResult result;
    FcPattern *pattern = FcPatternCreate();
    FcFontSet *set = NULL;
    bool bold = strstr(kind, "bold") != NULL;
    const char *family = strncmp(kind, "serif", 5) == 0  ? "serif"
                         : strncmp(kind, "mono", 4) == 0 ? "monospace"
                                                         : "sans-serif";
    if (!pattern) return NULL;
    FcPatternAddString(pattern, FC_FAMILY, (const FcChar8 *)family);
    FcPatternAddInteger(pattern, FC_WEIGHT, bold ? FC_WEIGHT_BOLD : FC_WEIGHT_REGULAR);
    FcPatternAddInteger(pattern, FC_SLANT, FC_SLANT_ROMAN);
    FcPatternAddBool(pattern, FC_SCALABLE, FcTrue);
    FcPatternAddCharSet(pattern, FC_CHARSET, wanted);
    if (language) FcPatternAddString(pattern, FC_LANG, (const FcChar8 *)language);
    if (FcConfigSubstitute(config, pattern, FcMatchPattern)) {
        FcDefaultSubstitute(pattern);
        set = FcFontSort(config, pattern, FcFalse, NULL, &result);
    }
    FcPatternDestroy(pattern);
    return set;
}

/* The file of a usable fallback font: outlines, uncoloured, the first face of its file; else NULL. */
static const char *usable(FcPattern *font)
{
    FcChar8 *file = NULL;
    FcBool scalable = FcFalse, outline = FcFalse, coloured = FcFalse;
    WrFileInfo info;
    int index = 0;
    if (FcPatternGetString(font, FC_FILE, 0, &file) != FcResultMatch) return NULL;
    FcPatternGetBool(font, FC_SCALABLE, 0, &scalable);
    FcPatternGetBool(font, FC_OUTLINE, 0, &outline);
    FcPatternGetBool(font, FC_COLOR, 0, &coloured);
    FcPatternGetInteger(font, FC_INDEX, 0, &index);
    if (!scalable || !outline || coloured || (index & 0xffff) != 0) return NULL;
    if (!wr_path_info((const char *)file, &info) || info.bytes > WR_FONT_FILE_MAX) return NULL;
    return (const char *)file;
}

/* The first font with the most wanted characters; removes these from the wanted set. A greedy set cover: few fonts for all
   missing characters, and fontconfig's order decides between equals. */
static const char *take_best(const FcFontSet *set, FcCharSet **wanted)
{
    FcCharSet *has = NULL, *best_has = NULL;
    const char *best = NULL;
    FcChar32 most = 0;
    for (int i = 0; i < set->nfont; i++) {
        const char *file = usable(set->fonts[i]);
        if (!file || FcPatternGetCharSet(set->fonts[i], FC_CHARSET, 0, &has) != FcResultMatch)
            continue;
        FcChar32 count = FcCharSetIntersectCount(has, *wanted);
        if (count <= most) continue;
        most = count;
        best = file;
        best_has = has;
    }
    if (!best) return NULL;
    FcCharSet *rest = FcCharSetSubtract(*wanted, best_has);
    FcCharSetDestroy(*wanted);
    *wanted = rest;
    return best;
}

int wr_font_lenders(const uint32_t *characters, int count, const char *kind, const char *language,
                    int most, char *paths[])
{
    int found = 0;
    if (!wr_font_config(NULL)) return 0;
    FcConfig *config = FcConfigReference(NULL);
    FcCharSet *wanted = FcCharSetCreate();
    for (int i = 0; i < count && wanted; i++) FcCharSetAddChar(wanted, characters[i]);
    FcFontSet *set = config && wanted ? sorted(config, wanted, kind, language) : NULL;
    while (set && wanted && found < most) {
        const char *file = take_best(set, &wanted);
        if (!file) break;
        paths[found++] = wr_strdup(file);
    }
    if (set) FcFontSetDestroy(set);
    if (wanted) FcCharSetDestroy(wanted);
    if (config) FcConfigDestroy(config);
    return found;
}
