/* Asking the reader process for a shaped text, and fonts by name. */
#include "base/file.h"
#include "image/font_inner.h"
#include "image/reader.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- names ---- */

const char *const wr_font_names[] = { "terminus", "terminus-bold", "sans", "sans-bold",
                                      "serif",    "serif-bold",    "mono", "mono-bold",
                                      "inter",    "inter-bold",    NULL };

typedef struct Place {
    const char *path, *package;
} Place;

static const Place places[] = {
    { "n", "xfonts-terminus" },
    { "b", "xfonts-terminus" },
    { "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "fonts-dejavu-core" },
    { "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf", "fonts-dejavu-core" },
    { "/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf", "fonts-dejavu-core" },
    { "/usr/share/fonts/truetype/dejavu/DejaVuSerif-Bold.ttf", "fonts-dejavu-core" },
    { "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf", "fonts-dejavu-core" },
    { "/usr/share/fonts/truetype/dejavu/DejaVuSansMono-Bold.ttf", "fonts-dejavu-core" },
    { "/usr/share/fonts/opentype/inter/Inter-Regular.otf", "fonts-inter" },
    { "/usr/share/fonts/opentype/inter/Inter-Bold.otf", "fonts-inter" },
};

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

char *wr_font_find(int index, double size, WrError *err)
{
    WrText path = { 0 };
    const Place *place = &places[index];
    if (place->path[0] == '/') wr_text_add(&path, place->path);
    else
        wr_text_addf(&path, "/usr/share/fonts/X11/misc/ter-u%d%s_unicode.pcf.gz",
                     terminus_dots(size), place->path);
    char *found = wr_strdup(wr_text_get(&path));
    wr_text_fini(&path);
    if (access(found, R_OK) == 0) return found;
    wr_fail(err, "the font %s is not installed (%s): install the package %s", wr_font_names[index],
            found, place->package);
    wr_free(found);
    return NULL;
}

/* ---- shaping ---- */

static bool read_inside(void)
{
    const char *where = getenv("WRINKLE_READER");
    return where && strcmp(where, "inside") == 0;
}

static bool shape_inside(const char *name, int fd, size_t length, const WrFontAsk *ask,
                         WrText *block, WrError *err)
{
    void *map = mmap(NULL, length, PROT_READ, MAP_PRIVATE, fd, 0);
    if (map == MAP_FAILED) return wr_fail(err, "%s: %s", name, strerror(errno));
    bool good = wr_font_make(map, length, ask, block, err);
    munmap(map, length);
    if (!good) wr_error_prefix(err, "%s: ", name);
    return good;
}

static bool shape_outside(const char *name, int fd, const WrFontAsk *ask, WrText *block,
                          WrError *err)
{
    const char *language = ask->language ? ask->language : "";
    WrFontOrder order = { ask->face, (int32_t)ask->direction, (int32_t)strlen(ask->text),
                          (int32_t)strlen(language) };
    WrText want = { 0 };
    wr_text_add_n(&want, (const char *)&order, sizeof order);
    wr_text_add_n(&want, ask->text, (size_t)order.text_length + 1);
    wr_text_add_n(&want, language, (size_t)order.language_length + 1);
    bool good = wr_reader_block(name, fd, WR_WIRE_FONT, want.data, want.length, &block->data,
                                &block->length, err);
    wr_text_fini(&want);
    return good;
}

static bool shape(const char *name, int fd, const WrFontAsk *ask, WrFontText *out, WrError *err)
{
    struct stat info;
    WrText block = { 0 };
    size_t length = strlen(ask->text);
    if (length > WR_FONT_TEXT_MAX)
        return wr_fail(err, "a text of %zu bytes: must be up to %d", length, WR_FONT_TEXT_MAX);
    if (ask->face < 0 || ask->face > 65535)
        return wr_fail(err, "%s: face %d: must be 0..65535", name, ask->face);
    if (ask->language && strlen(ask->language) > 64)
        return wr_fail(err, "a language of %zu letters: must be one as in \"ar\"",
                       strlen(ask->language));
    if (fstat(fd, &info) != 0) return wr_fail(err, "%s: %s", name, strerror(errno));
    if (S_ISDIR(info.st_mode)) return wr_fail(err, "%s: is a folder; a font is needed", name);
    if (!S_ISREG(info.st_mode)) return wr_fail(err, "%s: is not a regular file", name);
    if (info.st_size == 0) return wr_fail(err, "%s: is empty", name);
    if (info.st_size > WR_FONT_FILE_MAX)
        return wr_fail(err, "%s: has %.0f MB: fonts of up to %d MB are read", name,
                       (double)info.st_size / 1048576.0, WR_FONT_FILE_MAX >> 20);
    bool good = read_inside() ? shape_inside(name, fd, (size_t)info.st_size, ask, &block, err)
                              : shape_outside(name, fd, ask, &block, err);
    if (!good) return false;
    if (wr_font_unpack(block.data, block.length, length, out)) return true;
    wr_text_fini(&block);
    return wr_fail(err, "%s: what was read of it makes no sense; the font is damaged or hostile",
                   name);
}

bool wr_font_shape(const char *path, const WrFontAsk *ask, WrFontText *out, WrError *err)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return wr_fail(err, "%s: %s", path, strerror(errno));
    bool good = shape(path, fd, ask, out, err);
    close(fd);
    return good;
}

bool wr_font_shape_bytes(const char *name, const void *bytes, size_t length, const WrFontAsk *ask,
                         WrFontText *out, WrError *err)
{
    int fd = memfd_create("wrinkle font", MFD_CLOEXEC);
    const char *from = bytes;
    bool good = fd >= 0;
    for (size_t left = length; good && left > 0;) {
        ssize_t n = write(fd, from, left);
        if (n < 0 && errno == EINTR) continue;
        good = n > 0;
        if (good) from += n, left -= (size_t)n;
    }
    if (good) good = shape(name, fd, ask, out, err);
    else wr_fail(err, "%s: no memory to read it from", name);
    if (fd >= 0) close(fd);
    return good;
}
