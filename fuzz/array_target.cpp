// Arrays, images and DICOM files: the header, and the values as far as they are small.

#include "fuzz_input.h"

#include <bandvox/source/array_source.h>

#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bandvox;
    constexpr std::int64_t kMostValues = 1 << 16;
    static const fuzz::InputFile file(fuzz::extension(".npy"));
    fuzz::mayRefuse([&] {
        const auto source = openArray(file.write(data, size));
        const std::int64_t count = source->info().valuesPerSlice();
        if (count > kMostValues) return;
        std::vector<float> values(static_cast<std::size_t>(count));
        for (int slice = 0; slice < source->info().slices(); ++slice) source->readSlices(values);
    });
    return 0;
}
