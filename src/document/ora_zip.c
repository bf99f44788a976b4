#include "document/ora_zip.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "system/fd.h"

#include <string.h>
#include <zip.h>

#define ENTRIES_MAX 10000
#define PIECE ((zip_uint64_t)1 << 20)  /* bytes between two checks for cancellation */
#define TOTAL_MAX ((uint64_t)16 << 30) /* maximum bytes that are read from an archive in total */
#define RATIO_MAX 200
#define RATIO_FREE ((uint64_t)1 << 20) /* entries up to this many bytes may have any ratio */

struct WrOraZip {
    zip_t *archive;
    char *path;
    uint64_t total;
};

WrOraZip *wr_ora_zip_open(const char *path, WrError *err)
{
    int fd = wr_file_open(path, WR_FILE_MOST, NULL, err);
    return fd < 0 ? NULL : wr_ora_zip_take(path, fd, err);
}

WrOraZip *wr_ora_zip_take(const char *path, int fd, WrError *err)
{
    int trouble = 0;
    zip_t *archive = zip_fdopen(fd, 0, &trouble);
    if (!archive) {
        wr_fail(err, "%s: is not an OpenRaster file, truncated or damaged", path);
        wr_fd_close(fd);
        return NULL;
    }
    zip_int64_t entries = zip_get_num_entries(archive, 0);
    if (entries > ENTRIES_MAX) {
        wr_fail(err, "%s: holds %lld files; %d is the limit", path, (long long)entries,
                ENTRIES_MAX);
        zip_discard(archive);
        return NULL;
    }
    WrOraZip *zip = wr_alloc(1, sizeof *zip);
    *zip = (WrOraZip){ archive, wr_strdup(path), 0 };
    return zip;
}

void wr_ora_zip_close(WrOraZip *zip)
{
    if (!zip) return;
    zip_discard(zip->archive);
    wr_free(zip->path);
    wr_free(zip);
}

static bool check_entry(WrOraZip *zip, const char *name, size_t most, const zip_stat_t *is,
                        WrError *err)
{
    const zip_uint64_t needed =
        ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
    if ((is->valid & needed) != needed)
        return wr_fail(err, "%s: damaged: nothing is known of %.80s in it", zip->path, name);
    if (is->encryption_method != ZIP_EM_NONE)
        return wr_fail(err, "%s: %.80s in it is encrypted", zip->path, name);
    if (is->comp_method != ZIP_CM_STORE && is->comp_method != ZIP_CM_DEFLATE)
        return wr_fail(err,
                       "%s: %.80s in it is compressed by method %d; must be stored or deflated",
                       zip->path, name, is->comp_method);
    if (is->size > most)
        return wr_fail(err, "%s: %.80s in it has %.1f MB; %.1f MB is the limit", zip->path, name,
                       (double)is->size / 1e6, (double)most / 1e6);
    if (is->size > RATIO_FREE && is->size / RATIO_MAX > is->comp_size)
        return wr_fail(err, "%s: %.80s in it grows from %llu bytes to %.1f MB: hostile", zip->path,
                       name, (unsigned long long)is->comp_size, (double)is->size / 1e6);
    if (is->size > TOTAL_MAX - zip->total)
        return wr_fail(err, "%s: its files have more than %.0f MB in all", zip->path,
                       (double)TOTAL_MAX / 1e6);
    return true;
}

bool wr_ora_zip_read(WrOraZip *zip, const char *name, size_t most, char **bytes, size_t *length,
                     WrError *err)
{
    zip_stat_t is;
    zip_int64_t index = zip_name_locate(zip->archive, name, 0);
    if (index < 0 || zip_stat_index(zip->archive, (zip_uint64_t)index, 0, &is) != 0)
        return wr_fail(err, "%s: damaged: has no %.80s in it", zip->path, name);
    if (!check_entry(zip, name, most, &is, err)) return false;
    zip->total += is.size;
    char *block = wr_try_alloc((size_t)is.size + 1, 1, zip->path, err);
    if (!block) return false;
    zip_file_t *file = zip_fopen_index(zip->archive, (zip_uint64_t)index, 0);
    size_t have = 0;
    zip_int64_t n = file ? 1 : -1;
    while (n > 0 && have < is.size && !wr_progress_stopped()) {
        n = zip_fread(file, block + have, is.size - have < PIECE ? is.size - have : PIECE);
        if (n > 0) have += (size_t)n;
    }
    char beyond; /* the library verifies the checksum when the end is read */
    if (n > 0 || (n == 0 && is.size == 0)) n = zip_fread(file, &beyond, 1);
    if (file) zip_fclose(file);
    if (n != 0 || have != is.size) {
        wr_free(block);
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
        return wr_fail(err, "%s: %.80s in it cannot be read whole, truncated or damaged", zip->path,
                       name);
    }
    *bytes = block;
    *length = have;
    return true;
}
