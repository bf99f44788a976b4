/* Output file of an archive. The library itself would create a temporary file beside it, which remains if the
   program is killed. */
#include "document/ora_zip.h"

#include "base/error.h"

#include <errno.h>
#include <string.h>

static zip_int64_t answer_error(const WrOraSink *sink, void *data, zip_uint64_t length)
{
    int codes[2] = { ZIP_ER_WRITE, sink->error };
    if (length < sizeof codes) return -1;
    memcpy(data, codes, sizeof codes);
    return sizeof codes;
}

static zip_int64_t answer_stat(void *data, zip_uint64_t length)
{
    zip_stat_t *told = data;
    if (length < sizeof *told) return -1;
    zip_stat_init(told);
    told->size = 0;
    told->valid = ZIP_STAT_SIZE;
    return sizeof *told;
}

static zip_int64_t write_bytes(WrOraSink *sink, const char *bytes, zip_uint64_t length)
{
    if (!sink->error && !sink->to.write(sink->to.to, bytes, (size_t)length, sink->at))
        sink->error = errno;
    if (sink->error) return -1;
    sink->at += (int64_t)length;
    if (sink->at > sink->end) sink->end = sink->at;
    return (zip_int64_t)length;
}

static zip_int64_t move_to(WrOraSink *sink, void *data, zip_uint64_t length)
{
    zip_error_t error;
    zip_error_init(&error);
    zip_int64_t at = zip_source_seek_compute_offset((zip_uint64_t)sink->at, (zip_uint64_t)sink->end,
                                                    data, length, &error);
    zip_error_fini(&error);
    if (at < 0) return -1;
    sink->at = at;
    return 0;
}

static zip_int64_t on_sink(void *ctx, void *data, zip_uint64_t length, zip_source_cmd_t command)
{
    WrOraSink *sink = ctx;
    switch (command) {
    case ZIP_SOURCE_SUPPORTS:
        return zip_source_make_command_bitmap(
            ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE, ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR,
            ZIP_SOURCE_FREE, ZIP_SOURCE_SEEK, ZIP_SOURCE_TELL, ZIP_SOURCE_BEGIN_WRITE,
            ZIP_SOURCE_COMMIT_WRITE, ZIP_SOURCE_ROLLBACK_WRITE, ZIP_SOURCE_WRITE,
            ZIP_SOURCE_SEEK_WRITE, ZIP_SOURCE_TELL_WRITE, ZIP_SOURCE_REMOVE, -1);
    case ZIP_SOURCE_ERROR: return answer_error(sink, data, length);
    case ZIP_SOURCE_STAT: return answer_stat(data, length);
    case ZIP_SOURCE_WRITE: return write_bytes(sink, data, length);
    case ZIP_SOURCE_SEEK_WRITE: return move_to(sink, data, length);
    case ZIP_SOURCE_TELL_WRITE: return sink->at;
    case ZIP_SOURCE_COMMIT_WRITE: return sink->error ? -1 : 0;
    default: return 0;
    }
}

zip_t *wr_ora_sink_open(WrOraSink *sink, WrError *err)
{
    zip_error_t trouble;
    zip_error_init(&trouble);
    zip_source_t *source = zip_source_function_create(on_sink, sink, &trouble);
    zip_t *archive =
        source ? zip_open_from_source(source, ZIP_CREATE | ZIP_TRUNCATE, &trouble) : NULL;
    if (!archive) wr_fail(err, "%s", zip_error_strerror(&trouble));
    if (!archive && source) zip_source_free(source);
    zip_error_fini(&trouble);
    return archive;
}
