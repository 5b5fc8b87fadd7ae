// SPDX-License-Identifier: MIT
#include "scarp/source/raster/exr_raster.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "scarp/base/error.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/file_check.h"
#include "scarp/source/raster/opened_dataset.h"
#include "scarp/source/raster/raster_name.h"
#include "scarp/source/raster/raw_band.h"

namespace scarp {
namespace {

// The largest block of scan lines in most compression methods, so that no block is decompressed twice.
constexpr int kBlockRows = 32;

// Adapts GDAL's file access to OpenEXR, so that /vsizip and similar work.
class VsiStream final : public Imf::IStream {
 public:
  explicit VsiStream(const std::string& path) : IStream(path.c_str()), file_(VSIFOpenL(path.c_str(), "rb")) {
    if (!file_) throw Error("cannot be opened: permission denied, or no such file");
    VSIFSeekL(file_, 0, SEEK_END);
    bytes_ = VSIFTellL(file_);
    VSIFSeekL(file_, 0, SEEK_SET);
  }
  ~VsiStream() override { VSIFCloseL(file_); }
  VsiStream(const VsiStream&) = delete;
  VsiStream& operator=(const VsiStream&) = delete;

  bool read(char bytes[], int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (VSIFReadL(bytes, 1, wanted, file_) != wanted) throw std::runtime_error("the file ends too early");
    return VSIFTellL(file_) < bytes_;
  }
  std::uint64_t tellg() override { return VSIFTellL(file_); }
  void seekg(std::uint64_t position) override { VSIFSeekL(file_, position, SEEK_SET); }

 private:
  VSILFILE* file_;
  vsi_l_offset bytes_ = 0;
};

std::string names_of(const Imf::ChannelList& channels) {
  std::string names;
  for (auto it = channels.begin(); it != channels.end(); ++it)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", it.name());
  return names;
}

// There is at least one channel: OpenEXR rejects images without channels.
bool has_several(const Imf::ChannelList& channels) { return ++channels.begin() != channels.end(); }

std::string choose_channel(const Imf::ChannelList& channels, const std::string& wanted) {
  const std::string names = names_of(channels);
  if (!wanted.empty()) {
    if (channels.findChannel(wanted)) return wanted;
    throw Error(fmt::format("no channel '{}' (available: {})", wanted, names));
  }
  if (!has_several(channels)) return channels.begin().name();
  for (const char* name : {"Y", "R"}) {
    if (channels.findChannel(name)) return name;
  }
  throw Error(fmt::format("several channels (choose one with --channel: {})", names));
}

// One channel of the first part as a dataset with one band.
class ExrDataset final : public GDALDataset {
 public:
  ExrDataset(const std::string& path, const std::string& wanted) : stream_(path), file_(stream_), part_(open_part()) {
    const Imf::Header& header = part_.header();
    const Imath::Box2i window = header.dataWindow();
    const std::int64_t cols = std::int64_t{window.max.x} - window.min.x + 1,
                       rows = std::int64_t{window.max.y} - window.min.y + 1;
    constexpr std::int64_t kMost = std::numeric_limits<int>::max();
    if (cols < 1 || rows < 1 || cols > kMost || rows > kMost)
      throw Error(fmt::format("EXR of {} x {} samples (sides must be 1 to {})", cols, rows, kMost));
    nRasterXSize = static_cast<int>(cols);
    nRasterYSize = static_cast<int>(rows);
    west_ = window.min.x;
    north_ = window.min.y;
    channel_ = choose_channel(header.channels(), wanted);
    const Imf::Channel& channel = header.channels()[channel_];
    if (channel.xSampling != 1 || channel.ySampling != 1)
      throw Error(fmt::format(
          "channel '{}' is subsampled, without a sample for every pixel (choose another with --channel: {})", channel_,
          names_of(header.channels())));
    type_ = channel.type;
    SetBand(1, new Band(*this));
  }

  // The sample type as OpenEXR names it.
  std::string type_name() const { return type_ == Imf::HALF ? "half" : type_ == Imf::FLOAT ? "float" : "uint"; }
  const std::string& channel() const { return channel_; }
  bool has_several_channels() const { return has_several(part_.header().channels()); }
  std::string channel_names() const { return names_of(part_.header().channels()); }
  int parts() const { return file_.parts(); }

 private:
  class Band final : public GDALRasterBand {
   public:
    explicit Band(ExrDataset& owner) : owner_(owner) {
      poDS = &owner;
      nBand = 1;
      eDataType = owner.type_ == Imf::UINT ? GDT_UInt32 : GDT_Float32;
      nBlockXSize = owner.nRasterXSize;
      nBlockYSize = std::min(kBlockRows, owner.nRasterYSize);
    }

   protected:
    CPLErr IReadBlock(int, int block_row, void* data) override {
      const int first = block_row * nBlockYSize, rows = std::min(nBlockYSize, nRasterYSize - first);
      try {
        owner_.read_rows_into(first, rows, eDataType == GDT_UInt32 ? Imf::UINT : Imf::FLOAT, data);
        return CE_None;
      } catch (const std::exception& error) {
        CPLError(CE_Failure, CPLE_FileIO, "%s", error.what());
        return CE_Failure;
      }
    }

   private:
    ExrDataset& owner_;
  };

  Imf::InputPart open_part() {
    const Imf::Header& header = file_.header(0);
    if (header.hasType() && (header.type() == Imf::DEEPSCANLINE || header.type() == Imf::DEEPTILE))
      throw Error("deep EXR with several samples per pixel (flatten it first)");
    return Imf::InputPart(file_, 0);
  }

  void read_rows_into(int first, int rows, Imf::PixelType type, void* data) {
    Imf::FrameBuffer frame;
    frame.insert(channel_, Imf::Slice::Make(type, data, Imath::V2i(west_, north_ + first), nRasterXSize, rows));
    part_.setFrameBuffer(frame);
    part_.readPixels(north_ + first, north_ + first + rows - 1);
  }

  VsiStream stream_;
  Imf::MultiPartInputFile file_;
  Imf::InputPart part_;
  std::string channel_;
  Imf::PixelType type_ = Imf::FLOAT;
  int west_ = 0, north_ = 0;  // of the data window
};

std::unique_ptr<ExrDataset> open_exr(const std::string& path, const std::string& channel) {
  try {
    return std::make_unique<ExrDataset>(path, channel);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    std::string reason = error.what();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    throw Error(fmt::format("not an EXR image that OpenEXR can read: {}", reason));
  }
}

}  // namespace

OpenedDataset open_exr_raster(const std::string& path, const RasterOptions& options) {
  file_bytes(path);
  check_file(path);
  std::unique_ptr<ExrDataset> dataset = open_exr(path, options.channel);
  OpenedDataset opened;
  opened.file_type = dataset->type_name();
  if (options.channel.empty() && dataset->has_several_channels())
    opened.notes.push_back(fmt::format("reads channel {} of {} (choose another with --channel)", dataset->channel(),
                                       dataset->channel_names()));
  if (dataset->parts() > 1) opened.notes.push_back(fmt::format("reads the first of {} parts", dataset->parts()));
  opened.dataset.reset(dataset.release());
  return opened;
}

ExrSamples read_exr_channel(const std::string& path, const std::string& channel) {
  GdalSession session;
  ExrSamples samples;
  read_named(path, [&] {
    file_bytes(path);
    check_file(path);
    const std::unique_ptr<ExrDataset> dataset = open_exr(path, channel);
    samples.width = dataset->GetRasterXSize(), samples.height = dataset->GetRasterYSize();
    const auto width = static_cast<std::size_t>(samples.width), height = static_cast<std::size_t>(samples.height);
    samples.values.resize(width * height);
    if (dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, samples.width, samples.height, samples.values.data(),
                                            samples.width, samples.height, GDT_Float32, 0, 0, nullptr) != CE_None)
      throw Error(fmt::format("channel '{}' cannot be read: {}", channel, CPLGetLastErrorMsg()));
  });
  return samples;
}

}  // namespace scarp
