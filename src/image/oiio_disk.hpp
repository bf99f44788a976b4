/* oiio_disk.hpp - buffered output proxy between an image library and a byte sink. C++, only in the
   module.
   Private to this module. */
#pragma once
#include "base/sink.h"

#include <OpenImageIO/filesystem.h>

#include <cerrno>
#include <cstring>
#include <vector>

/* An output of the caller for a library: accepts every write and stores the first failure. */
class Disk : public OIIO::Filesystem::IOProxy
{
  public:
    explicit Disk(const WrByteSink &to) : IOProxy("", Write), sink(to), block(1 << 16)
    {
    }
    const char *proxytype() const override
    {
        return "disk";
    }
    bool seek(int64_t offset) override
    {
        m_pos = offset;
        return true;
    }
    int64_t tell() override
    {
        return m_pos;
    }
    size_t read(void *, size_t) override
    {
        return 0;
    }
    size_t write(const void *bytes, size_t count) override
    {
        const char *from = static_cast<const char *>(bytes);
        for (size_t left = count; left > 0;) {
            if (m_pos != at + static_cast<int64_t>(held) || held == block.size()) empty();
            size_t take = std::min(left, block.size() - held);
            std::memcpy(block.data() + held, from, take);
            held += take;
            from += take;
            left -= take;
            m_pos += static_cast<int64_t>(take);
        }
        if (m_pos > end) end = m_pos;
        return count;
    }
    size_t size() const override
    {
        return static_cast<size_t>(end);
    }
    /* Flushes the buffer and continues at the library's present position. */
    void empty()
    {
        if (held > 0 && !error && !sink.write(sink.to, block.data(), held, at)) error = errno;
        held = 0;
        at = m_pos;
    }
    int error = 0; /* errno of the first failure */

  private:
    WrByteSink sink;
    std::vector<char> block; /* bytes to be written at `at` */
    size_t held = 0;
    int64_t at = 0, end = 0;
};
