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
    return wr_fail(err, "%s: the reader's answer makes no sense; the file is damaged or hostile",
                   name);
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

void wr_svg_fini(WrSvg *svg)
{
    wr_free(svg->block);
    *svg = (WrSvg){ 0 };
}
