// SPDX-License-Identifier: MIT
// Writes GeoPackages of shapes for tests.
#pragma once

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace scarp::test {

struct VectorShape {
  const char *layer, *name, *wkt;
};

// In EPSG:32633, with a column "name". Layers come in the order of their first shapes, and have the type of their
// shapes, if that is one.
inline std::string vector_package(const std::string& path, const std::vector<VectorShape>& shapes) {
  GDALAllRegister();
  const GDALDatasetUniquePtr file(
      GetGDALDriverManager()->GetDriverByName("GPKG")->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  OGRSpatialReference utm;
  utm.importFromEPSG(32633);
  const auto geometry = [&](const VectorShape& shape) {
    OGRGeometry* read = nullptr;
    EXPECT_EQ(OGRGeometryFactory::createFromWkt(shape.wkt, &utm, &read), OGRERR_NONE) << shape.wkt;
    return std::unique_ptr<OGRGeometry>(read);
  };
  std::map<std::string, std::set<OGRwkbGeometryType>> types;
  for (const VectorShape& shape : shapes) types[shape.layer].insert(geometry(shape)->getGeometryType());
  for (const VectorShape& shape : shapes) {
    OGRLayer* layer = file->GetLayerByName(shape.layer);
    if (!layer) {
      const auto& all = types[shape.layer];
      layer = file->CreateLayer(shape.layer, &utm, all.size() == 1 ? *all.begin() : wkbUnknown, nullptr);
      OGRFieldDefn name("name", OFTString);
      EXPECT_EQ(layer->CreateField(&name), OGRERR_NONE);
    }
    OGRFeature feature(layer->GetLayerDefn());
    feature.SetGeometryDirectly(geometry(shape).release());
    feature.SetField("name", shape.name);
    EXPECT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
  }
  return path;
}

}  // namespace scarp::test
