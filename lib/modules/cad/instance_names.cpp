#include "instance_names.h"

#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS_Iterator.hxx>
#include <TransferBRep.hxx>

namespace bandvox {
namespace {

std::string textOf(const Handle(TCollection_HAsciiString) & text) {
    return text.IsNull() ? std::string() : std::string(text->ToCString());
}

std::string productOf(const Handle(StepBasic_ProductDefinition) & definition) {
    if (definition.IsNull() || definition->Formation().IsNull()) return {};
    const Handle(StepBasic_Product) product = definition->Formation()->OfProduct();
    return product.IsNull() ? std::string() : textOf(product->Name());
}

}  // namespace

InstanceNames::InstanceNames(const Handle(Transfer_TransientProcess) & process,
                             const TopoDS_Shape& whole) {
    for (int k = 1; k <= process->NbMapped(); ++k) {
        const auto instance =
            Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(process->Mapped(k));
        if (instance.IsNull()) continue;
        const TopoDS_Shape shape = TransferBRep::ShapeResult(process, instance);
        std::string name = textOf(instance->Name());
        if (name.empty()) name = productOf(instance->RelatedProductDefinition());
        if (shape.IsNull() || name.empty()) continue;
        mInstances.Bind(shape, static_cast<int>(mNames.size()));
        mNames.push_back(std::move(name));
    }
    if (!mNames.empty()) walk(whole, {}, {});
}

std::string InstanceNames::nameOf(const TopoDS_Shape& part) const {
    const int* const found = mParts.Seek(part);
    return found ? mPaths[static_cast<std::size_t>(*found)] : std::string();
}

void InstanceNames::walk(const TopoDS_Shape& shape, const TopLoc_Location& place,
                         const std::string& path) {
    std::string inner = path;
    if (const int* const found = mInstances.Seek(shape)) {
        if (!inner.empty()) inner += '/';
        inner += mNames[static_cast<std::size_t>(*found)];
    }
    const TopAbs_ShapeEnum kind = shape.ShapeType();
    if (kind == TopAbs_SOLID || kind == TopAbs_SHELL) {
        mParts.Bind(shape.Moved(place), static_cast<int>(mPaths.size()));
        mPaths.push_back(std::move(inner));
        return;
    }
    if (kind != TopAbs_COMPOUND && kind != TopAbs_COMPSOLID) return;
    const TopLoc_Location within = place * shape.Location();
    for (TopoDS_Iterator part(shape, false, false); part.More(); part.Next()) {
        walk(part.Value(), within, inner);
    }
}

}  // namespace bandvox
