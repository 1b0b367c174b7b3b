// STEP, IGES and BREP by Open CASCADE: a module beside the library, or a part of it where that is
// static.
#include "source/cad_library.h"

#include "core/letter_case.h"
#include "face_reader.h"
#include "instance_names.h"

#include <bandvox/core/error.h>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Protocol.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <cmath>
#include <fstream>
#include <ios>
#include <mutex>
#include <string>

namespace bandvox {
namespace {

// Faces that share no edges may have them in the same places.
constexpr double kSewing = 1e-5;  // of the shape's size

TopoDS_Shape sewn(const TopoDS_Shape& shape) {
    const TopExp_Explorer loose(shape, TopAbs_FACE, TopAbs_SHELL);
    if (!loose.More()) return shape;
    Bnd_Box box;
    BRepBndLib::AddOptimal(shape, box, false, false);
    if (box.IsVoid()) return shape;
    BRepBuilderAPI_Sewing sewing(kSewing * std::sqrt(box.SquareExtent()));
    sewing.Add(shape);
    sewing.Perform();
    const TopoDS_Shape& result = sewing.SewedShape();
    return result.IsNull() ? shape : result;
}

void requireDone(IFSelect_ReturnStatus status, const char* kind) {
    if (status == IFSelect_RetDone) return;
    throw Error(ErrorKind::Input, std::string("is malformed; expected a whole ") + kind + " file");
}

class OpenCascade final : public CadLibrary {
  public:
    OpenCascade() {
        // The standard output is for results.
        Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
    }

    CadShape read(const std::filesystem::path& path, const InterruptCheck& check) const override {
        // Its readers have tables in common.
        static std::mutex mutex;
        const std::scoped_lock lock(mutex);
        try {
            const std::string extension = lowerExtension(path);
            if (extension == ".brep") return readBrep(path, check);
            if (extension == ".iges" || extension == ".igs") return readIges(path, check);
            return readStep(path, check);
        } catch (const Standard_Failure& failure) {
            const char* text = failure.GetMessageString();
            throw Error(ErrorKind::Input,
                        std::string("cannot be read: Open CASCADE says ") +
                            (text && *text ? text : failure.DynamicType()->Name()) +
                            "; expected a sound part");
        }
    }

  private:
    static CadShape readBrep(const std::filesystem::path& path, const InterruptCheck& check) {
        TopoDS_Shape shape;
        const BRep_Builder builder;
        std::ifstream stream(path, std::ios::binary);
        // What is no number where one is due would be waited for without end.
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        try {
            BRepTools::Read(shape, stream, builder);
        } catch (const std::ios_base::failure&) {
            shape.Nullify();
        }
        if (shape.IsNull()) {
            throw Error(ErrorKind::Input, "is malformed; expected a whole BREP file");
        }
        return facesOf(
            sewn(shape), [](const TopoDS_Shape&) { return std::string(); }, check);
    }

    // What a reader does not know it leaves out.
    static void warnOfUnknown(const XSControl_Reader& reader, CadShape& shape) {
        const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
        int unknown = 0;
        for (int k = 1; k <= model->NbEntities(); ++k) {
            unknown += model->Protocol()->IsUnknownEntity(model->Value(k)) ? 1 : 0;
        }
        if (unknown == 0) return;
        shape.warnings.push_back(
            "entities of types that Open CASCADE does not know were left out: " +
            std::to_string(unknown) + "; faces may be missing");
    }

    static CadShape readIges(const std::filesystem::path& path, const InterruptCheck& check) {
        IGESControl_Reader reader;
        requireDone(reader.ReadFile(path.c_str()), "IGES");
        reader.TransferRoots();
        const TopoDS_Shape shape = reader.OneShape();
        if (shape.IsNull()) return {};
        CadShape result = facesOf(
            sewn(shape), [](const TopoDS_Shape&) { return std::string(); }, check);
        warnOfUnknown(reader, result);
        return result;
    }

    static CadShape readStep(const std::filesystem::path& path, const InterruptCheck& check) {
        STEPControl_Reader reader;
        requireDone(reader.ReadFile(path.c_str()), "STEP");
        reader.TransferRoots();
        const TopoDS_Shape shape = reader.OneShape();
        if (shape.IsNull()) return {};
        const Handle(XSControl_TransferReader) transfer = reader.WS()->TransferReader();
        const InstanceNames instances(transfer->TransientProcess(), shape);
        const auto nameOf = [&](const TopoDS_Shape& part) {
            if (std::string name = instances.nameOf(part); !name.empty()) return name;
            const auto item = Handle(StepRepr_RepresentationItem)::DownCast(
                transfer->EntityFromShapeResult(part, 1));
            if (item.IsNull() || item->Name().IsNull()) return std::string();
            return std::string(item->Name()->ToCString());
        };
        CadShape result = facesOf(sewn(shape), nameOf, check);
        warnOfUnknown(reader, result);
        return result;
    }
};

}  // namespace

extern "C" const CadLibrary* bandvoxCadLibrary();

extern "C" const CadLibrary* bandvoxCadLibrary() {
    static const OpenCascade library;
    return &library;
}

}  // namespace bandvox
