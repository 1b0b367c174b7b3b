#pragma once

#include <bandvox/core/progress.h>

#include <ios>
#include <streambuf>

namespace bandvox {

/// Hands what is written on to another buffer, until the work is to stop: then writing throws
/// Error(ErrorKind::Interrupted), as a stream does that is told to throw when it is bad.
class WatchedOutput final : public std::streambuf {
  public:
    WatchedOutput(std::streambuf& to, const Progress& progress) : mTo(to), mProgress(progress) {}

  protected:
    std::streamsize xsputn(const char* from, std::streamsize count) override {
        mProgress.throwIfInterrupted();
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
    const Progress& mProgress;
};

}  // namespace bandvox
