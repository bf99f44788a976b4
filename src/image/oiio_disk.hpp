/* oiio_disk.hpp - the file that a picture library writes to. C++, part of the module alone.
   Private to this room. */
#pragma once
#include <OpenImageIO/filesystem.h>

#include <cerrno>
#include <cstdio>
#include <string>

/* A file for a library to write that takes everything and remembers the first failure. */
class Disk : public OIIO::Filesystem::IOProxy
{
  public:
    explicit Disk(const std::string &path)
        : IOProxy(path, Write), file(std::fopen(path.c_str(), in_memory(path) ? "wb" : "wbx"))
    {
        if (!file) error = errno;
    }
    ~Disk() override
    {
        shut();
    }
    const char *proxytype() const override
    {
        return "disk";
    }
    bool seek(int64_t offset) override
    {
        m_pos = offset;
        if (!error && fseeko(file, offset, SEEK_SET) != 0) error = errno;
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
        if (!error && count && std::fwrite(bytes, 1, count, file) != count) error = errno;
        m_pos += static_cast<int64_t>(count);
        if (m_pos > end) end = m_pos;
        return count;
    }
    size_t size() const override
    {
        return static_cast<size_t>(end);
    }
    void shut()
    {
        if (file && std::fclose(file) != 0 && !error) error = errno;
        file = nullptr;
    }
    int error = 0; /* errno of the first failure */

  private:
    /* A memory file of the caller's is there already. */
    static bool in_memory(const std::string &path)
    {
        return path.compare(0, 14, "/proc/self/fd/") == 0;
    }
    FILE *file;
    int64_t end = 0;
};
