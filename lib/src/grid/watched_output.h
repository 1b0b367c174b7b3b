#pragma once

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/progress.h>

#include <ios>
#include <streambuf>

namespace bandvox {

/// Hands what is written on to the buffer of a file, until the work is to stop: then writing throws
/// Error(ErrorKind::Interrupted), as a stream does that is told to throw when it is bad. Now and
/// then the system is told to begin with the disk.
class WatchedOutput final : public std::streambuf {
  public:
    WatchedOutput(std::streambuf& to, AtomicFile& file, const Progress& progress)
        : mTo(to), mFile(file), mProgress(progress) {}

  protected:
    std::streamsize xsputn(const char* from, std::streamsize count) override {
        mProgress.throwIfInterrupted();
        constexpr std::streamsize kBetweenSyncs = 16 << 20;
        mSinceSync += count;
        if (mSinceSync > kBetweenSyncs) {
            mSinceSync = 0;
            mFile.beginSync();
        }
        return mTo.sputn(from, count);
    }
    int_type overflow(int_type c) override {
        return traits_type::eq_int_type(c, traits_type::eof())
                   ? traits_type::not_eof(c)
                   : mTo.sputc(traits_type::to_char_type(c));
    }
    std::streampos seekoff(std::streamoff offset, std::ios::seekdir from,
                           std::ios::openmode which) override {
        return mTo.pubseekoff(offset, from, which);
    }
    std::streampos seekpos(std::streampos place, std::ios::openmode which) override {
        return mTo.pubseekpos(place, which);
    }
    int sync() override { return mTo.pubsync(); }

  private:
    std::streambuf& mTo;
    AtomicFile& mFile;
    const Progress& mProgress;
    std::streamsize mSinceSync = 0;
};

}  // namespace bandvox
