#include "image/svg.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/reader_client.h"
#include "system/fd.h"

#include <string.h>

/* The block is untrusted. */
static bool check_block(char *block, size_t length, WrSvg *svg)
{
    WrSvgHead head;
    if (length < sizeof head) return false;
    memcpy(&head, block, sizeof head);
    if (head.width < 3 || head.width > WR_SVG_SIDE_MAX + 2 || head.height < 3 ||
        head.height > WR_SVG_SIDE_MAX + 2 ||
        length != sizeof head + (size_t)head.width * (size_t)head.height)
        return false;
    for (int k = 0; k < 2; k++)
        if (!(head.box[k] > 0.0 && head.box[k] <= WR_SVG_SIDE_MAX)) return false;
    *svg = (WrSvg){ .width = head.width,
                    .height = head.height,
                    .box = { head.box[0], head.box[1] },
                    .text = head.text != 0,
                    .cover = (const uint8_t *)block + sizeof head,
                    .block = block };
    return true;
}

/* Owns the block. */
static bool take(const char *name, char *block, size_t length, WrSvg *out, WrError *err)
{
    if (check_block(block, length, out)) return true;
    wr_free(block);
    return wr_fail(
        err, "%s: the reader process returned invalid data; the file is damaged or hostile", name);
}

bool wr_svg_read_bytes(const char *name, const void *bytes, size_t length, const WrSvgRequest *ask,
                       WrSvg *out, WrError *err)
{
    WrText block = { 0 };
    bool memory = false, good;
    if (length == 0) return wr_fail(err, "%s: is empty", name);
    if (wr_reader_inside()) {
        good = wr_svg_make(bytes, length, ask, &block, &memory, err);
        if (!good) wr_error_prefix(err, "%s: ", name);
    } else {
        const int fd = wr_fd_in_memory(name, bytes, length, err);
        good = fd >= 0 && wr_reader_block(name, fd, WR_WIRE_SVG, ask, sizeof *ask, &block.data,
                                          &block.length, err);
        if (fd >= 0) wr_fd_close(fd);
    }
    if (good) return take(name, block.data, block.length, out, err);
    wr_text_fini(&block);
    return false;
}

bool wr_svg_read(const char *path, const WrSvgRequest *ask, WrSvg *out, WrError *err)
{
    char *bytes;
    size_t length;
    if (!wr_file_read(path, WR_SVG_FILE_MAX, &bytes, &length, err)) return false;
    const bool good = wr_svg_read_bytes(path, bytes, length, ask, out, err);
    wr_free(bytes);
    return good;
}

/* ---- recognition ---- */

bool wr_svg_named(const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    return strcmp(ending, "svg") == 0 || strcmp(ending, "svgz") == 0;
}

static const char *skip_blanks(const char *text)
{
    return text + strspn(text, " \t\r\n");
}

bool wr_svg_is_text(const char *text)
{
    if (strncmp(text, "\xEF\xBB\xBF", 3) == 0) text += 3; /* byte order mark */
    text = skip_blanks(text);
    if (strncmp(text, "<svg", 4) == 0) return true;
    return (strncmp(text, "<?xml", 5) == 0 || strncmp(text, "<!", 2) == 0) && strstr(text, "<svg");
}

size_t wr_svg_path_span(const char *text)
{
    return strspn(text, "MmZzLlHhVvCcSsQqTtAaEe0123456789+-., \t\r\n");
}

/* M and a number, then only letters of path data. */
static bool is_path_data(const char *text)
{
    const char *first = skip_blanks(text);
    if (*first != 'M' && *first != 'm') return false;
    first = skip_blanks(first + 1);
    return *first && strchr("0123456789+-.", *first) && !text[wr_svg_path_span(text)];
}

/* Value of a tag's attribute: its first letter and its length; NULL: the tag has none. end: of the tag. */
static const char *attribute(const char *tag, const char *end, const char *name, size_t *length)
{
    const size_t count = strlen(name);
    for (const char *at = tag; (at = strstr(at, name)) && at < end; at += count) {
        const char quote = at[count] == '=' ? at[count + 1] : '\0';
        if (!strchr(" \t\r\n", at[-1]) || (quote != '"' && quote != '\'')) continue;
        const char *from = at + count + 2, *to = strchr(from, quote);
        *length = to ? (size_t)(to - from) : 0;
        return to && to < end ? from : NULL;
    }
    return NULL;
}

static bool is_none(const char *tag, const char *end)
{
    size_t length;
    const char *fill = attribute(tag, end, "fill", &length);
    return fill && length == 4 && strncmp(fill, "none", 4) == 0;
}

char *wr_svg_one_path(const char *text)
{
    /* anything that draws something else, or draws the path in another way */
    static const char *const others[] = {
        "<rect",  "<circle",  "<ellipse", "<line",     "<poly",   "<use",      "<image",
        "<text",  "<style",   "<g",       "<a",        "<switch", "<symbol",   "<clip",
        "<mask",  "<!ENTITY", "<svg:",    "style=",    "class=",  "transform", "fill-rule",
        "stroke", "display",  "opacity",  "visibility"
    };
    if (is_path_data(text)) return wr_strdup(text);
    const char *root = wr_svg_is_text(text) ? strstr(text, "<svg") : NULL;
    const char *tag = root ? strstr(root, "<path") : NULL;
    if (!tag || strstr(tag + 1, "<path") || strstr(root + 1, "<svg")) return NULL;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strstr(text, others[i])) return NULL;
    const char *root_end = strchr(root, '>'), *end = strchr(tag, '>');
    size_t length, unused;
    const char *d = end ? attribute(tag, end, "d", &length) : NULL;
    const bool own = d && attribute(tag, end, "fill", &unused);
    if (!d || is_none(own ? tag : root, own ? end : root_end)) return NULL;
    char *path = wr_strndup(d, length);
    if (is_path_data(path)) return path;
    wr_free(path);
    return NULL;
}

void wr_svg_fini(WrSvg *svg)
{
    wr_free(svg->block);
    *svg = (WrSvg){ 0 };
}
